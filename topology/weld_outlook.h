// Prediction of the result of welding a mesh: whether it would be sound, and which cells would be
// joined.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// The predicted result of welding.
struct WeldOutlook {
    /// The first error of the welded mesh. Empty if there is none, or if the mesh has errors
    /// without welding.
    std::optional<std::string> error;
    std::size_t num_joined = 0;  ///< points that would be joined to others
    std::size_t num_idle = 0;    ///< of these, the points at which no faces would be joined
    /// Two cells, the first with a quadrilateral face and the second with a triangle on it, if
    /// there are such cells. Welding cannot join these faces.
    std::optional<std::pair<std::size_t, std::size_t>> unlike_faces;
};

/// Returns the predicted result of weld(). Cost: that of two checks and of welding a copy.
/// @pre  corners are valid point numbers, and all coordinates are finite
WeldOutlook outlook_of_weld(const MeshData& data);

/// Returns, by point, whether it is a corner of a face that belongs to only one cell.
/// @pre  corners are valid point numbers, and all coordinates are finite
std::vector<bool> points_of_boundary(const MeshData& data);

}  // namespace incise::topology
