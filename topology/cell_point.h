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

/// A point of a cell: x = sum of weight times x_corner. The weights are not negative and sum to 1.
struct CellPoint {
    CellId cell;
    std::array<double, max_corners> weights{};  ///< by corner; those beyond the last one are 0

    /// Returns its position, m.
    /// @param positions  by node id, m
    Vec3 position(const Mesh& mesh, std::span<const Vec3> positions) const;
    static void archive(auto& ar, auto& self) { ar(self.cell, self.weights); }
};

/// Returns the point of a cell that lies at `x`, or, if `x` is outside, a point of its surface near
/// `x`. A cell that is no tetrahedron is divided into tetrahedra that meet at its centre, and the
/// weights are linear in each of them.
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
