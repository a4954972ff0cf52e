// What would come of welding a mesh: whether it would be sound, and which cells would hang
// together.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

struct WeldOutlook {
    /// The first error of the welded mesh. Empty if the mesh has errors as it is.
    std::optional<std::string> error;
    std::size_t num_joined = 0;  ///< points that would be joined to others
    std::size_t num_idle = 0;    ///< of these, the ones at which no faces would come together
    /// Two cells of which a quadrilateral lies on a triangle, if there are any: faces that no
    /// welding makes one.
    std::optional<std::pair<std::size_t, std::size_t>> unlike_faces;
};

/// @pre  as coincidence_warning()
/// Cost: that of two checks and of welding a copy.
WeldOutlook outlook_of_weld(const MeshData& data);

/// Of each point, whether it is a corner of a face that belongs to one cell only.
/// @pre  as above
std::vector<bool> points_of_boundary(const MeshData& data);

}  // namespace incise::topology
