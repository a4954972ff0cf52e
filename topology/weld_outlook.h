// Prediction of the result of welding a mesh: whether it would be sound, and which cells would be
// joined.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// A quadrilateral boundary face, and the triangular boundary faces on it: they have three of its
/// four corners. Such faces are not joined: find_joined_quads() says which would be.
struct UnlikeFaces {
    std::size_t cell;                       ///< of the quadrilateral
    std::vector<std::size_t> of_triangles;  ///< the cells of the triangles, ascending; at least one
};

/// Returns the first quadrilateral boundary face with triangles on it, or nothing if there is none.
/// @param checked  the result of check(data), without errors
std::optional<UnlikeFaces> find_unlike_faces(const MeshData& data, const MeshCheck& checked);

/// Returns a name for messages, such as "the quadrilateral of cell 3 (hexahedron) and the triangles
/// of cell 8 (tetrahedron) and cell 9 (tetrahedron) on it".
std::string name_of(const UnlikeFaces& faces, const MeshData& data);

/// What joins a quadrilateral and triangles on it: the end of a message.
inline constexpr const char* remedy_for_unlike_faces =
    "let two triangles, which share one of its diagonals, cover each such quadrilateral";

/// The predicted result of welding.
struct WeldOutlook {
    /// The first error of the welded mesh. Empty if there is none, or if the mesh has errors
    /// without welding.
    std::optional<std::string> error;
    std::size_t num_joined = 0;  ///< points that would be joined to others
    std::size_t num_idle = 0;    ///< of these, the points at which no faces would be joined
    /// Faces that welding cannot join, if there are any.
    std::optional<UnlikeFaces> unlike_faces;
};

/// Returns the predicted result of weld(). Cost: that of two checks and of welding a copy.
/// @pre  corners are valid point numbers, and all coordinates are finite
WeldOutlook outlook_of_weld(const MeshData& data);

/// Returns, by point, whether it is a corner of a face that belongs to only one cell.
/// @pre  corners are valid point numbers, and all coordinates are finite
std::vector<bool> points_of_boundary(const MeshData& data);

}  // namespace incise::topology
