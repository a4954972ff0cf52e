// A point of the material, as a combination of the corners of a cell.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// A point of a cell: x = sum of weight times x_corner, over some of the corners. The weights are
/// not negative and sum to 1.
struct CellPoint {
    CellId cell;
    std::array<VertexId, max_corners> corners{};
    std::array<double, max_corners> weights{};
    int count = 0;  ///< of corners that are named

    /// Calls visit(corner, weight) for each of them.
    template <class Visit>
    void for_each(Visit visit) const {
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
            visit(corners[k], weights[k]);
    }
    /// Returns its position, m.
    /// @param positions  by node id, m
    Vec3 position(std::span<const Vec3> positions) const {
        Vec3 x = Vec3::Zero();
        for_each([&](VertexId n, double weight) { x += weight * positions[n.index()]; });
        return x;
    }
    static void archive(auto& ar, auto& self) {
        ar(self.cell, self.corners, self.weights, self.count);
    }
};

/// Returns the point of a cell that lies at `x`, or, if `x` is outside, a point of its surface near
/// `x`. A cell that is no tetrahedron is divided into tetrahedra that meet at its centre, and the
/// weights are linear in each of them; a polyhedron into those that meet at its first corner.
/// @param positions  by node id, m
/// @param x          m
CellPoint point_near(const Mesh& mesh, CellId cell, std::span<const Vec3> positions, const Vec3& x);

/// Returns the point of a mesh that lies at `x`, or one near `x` that is not farther than `reach`.
/// Cost: O(n).
/// @param positions  by node id, m
/// @param x, reach   m
std::optional<CellPoint> find_point(const Mesh& mesh, std::span<const Vec3> positions,
                                    const Vec3& x, double reach);

}  // namespace incise::topology
