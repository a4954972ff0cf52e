// Whether the parts of a mesh that was read fit one another.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/topology/mesh_data.h"
#include "incise/topology/polyhedron_check.h"

namespace incise::support {

/// What does not fit, or an empty text.
inline std::string inconsistency_of(const topology::MeshData& mesh) {
    if (mesh.num_cells() == 0) return "there are no cells";
    if (mesh.offsets.size() != mesh.num_cells() + 1) return "offsets do not fit the cells";
    if (mesh.regions.size() != mesh.num_cells()) return "regions do not fit the cells";
    if (mesh.offsets.back() != mesh.corners.size()) return "offsets do not fit the corners";
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        const auto corners = mesh.cell(c);
        const auto name = "cell " + std::to_string(c);
        if (mesh.kinds[c] != topology::CellKind::polyhedron &&
            corners.size() != static_cast<std::size_t>(topology::traits(mesh.kinds[c]).num_corners))
            return name + " has " + std::to_string(corners.size()) + " corners";
        for (const auto corner : corners) {
            if (corner < 0 || static_cast<std::size_t>(corner) >= mesh.points.size())
                return name + " has point " + std::to_string(corner);
            if (!mesh.points[static_cast<std::size_t>(corner)].allFinite())
                return name + " has a point that is not finite";
        }
    }
    return topology::fault_of_face_lists(mesh);
}

}  // namespace incise::support
