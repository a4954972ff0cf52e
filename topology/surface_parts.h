// The parts of a triangulated surface: what of it is connected, closed, and which way it faces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/surface_data.h"

namespace incise::topology {

/// One part of a surface. Triangles with a common edge are of one part, unless more than two meet
/// there.
struct SurfacePart {
    std::size_t num_triangles = 0;
    bool is_closed = true;
    /// The volume that a closed part encloses; below 0 if its triangles face inwards.
    double signed_volume = 0.0;
    Box box;
};

/// Edges at which a surface is not closed, and the middle of the first of them.
struct EdgeFault {
    std::size_t count = 0;
    Vec3 place = Vec3::Zero();
};

/// A surface and its parts. Lengths are in the unit of the source.
struct SurfaceParts {
    /// The surface with equal points as one, and as without_flat_triangles(). The triangles of a
    /// part face the same side, that of its first triangle in the source.
    SurfaceData surface;
    std::vector<std::size_t> part_of_triangle;  ///< by triangle of `surface`
    std::vector<SurfacePart> parts;             ///< in the order of their first triangles

    EdgeFault open_edges;       ///< with one triangle only
    EdgeFault branching_edges;  ///< with more than two triangles
    /// Edges whose triangles cannot be turned to face one side, as on a Moebius strip.
    EdgeFault one_sided_edges;
    std::size_t num_turned = 0;  ///< triangles that were turned

    double area = 0.0;
    Box box;

    bool is_closed() const {
        return open_edges.count == 0 && branching_edges.count == 0 && one_sided_edges.count == 0;
    }
};

/// Returns the parts of a surface. Cost: O(n log n).
SurfaceParts parts_of(const SurfaceData& surface);

/// Returns what keeps the surface from being closed, with the place and a remedy, as an end of a
/// sentence that begins with its name; empty if it is closed.
std::string fault_of(const SurfaceParts& parts);

}  // namespace incise::topology
