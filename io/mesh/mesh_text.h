// Meshes as text, one function a format; mesh_writer.cpp holds the table of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// What meshes whose points may coincide say of themselves, in a comment near the start of the
/// file.
inline constexpr std::string_view coincidence_mark =
    "Incise: points at one position are on the two faces of a cut";

std::string legacy_vtk_text(const topology::MeshData& mesh);
std::string gmsh_text(const topology::MeshData& mesh);
std::string medit_text(const topology::MeshData& mesh);
std::string abaqus_text(const topology::MeshData& mesh);

/// Corners in the order of Gmsh, MEDIT and Abaqus: the first triangle of a wedge faces the second
/// one, where VTK's faces away from it. The other kinds of cell agree.
struct ReorderedCell {
    std::array<std::int64_t, topology::max_corners> corners;
    std::size_t num_corners;

    // Iterated over itself, not through a view, so that a loop may take a temporary.
    const std::int64_t* begin() const { return corners.data(); }
    const std::int64_t* end() const { return corners.data() + num_corners; }
};
ReorderedCell with_wedges_facing_inwards(const topology::MeshData& mesh, std::size_t cell);

/// "x<separator>y<separator>z", in digits that read back to the same bits.
void append_point(std::string& text, const Vec3& point, char separator = ' ');

}  // namespace incise::io
