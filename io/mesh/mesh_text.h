// Conversion of meshes to text, with one function a format. mesh_writer.cpp has the table of them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// The comment near the beginning of a file of a mesh whose points may coincide.
inline constexpr std::string_view coincidence_mark =
    "Incise: points at one position are on the two faces of a cut";

std::string legacy_vtk_text(const topology::MeshData& mesh);
std::string gmsh_text(const topology::MeshData& mesh);
std::string medit_text(const topology::MeshData& mesh);
std::string abaqus_text(const topology::MeshData& mesh);
/// @pre  all cells are tetrahedra
std::string usda_text(const topology::MeshData& mesh);

/// The corners of a cell in the order of Gmsh, MEDIT and Abaqus. The normal of the first triangle
/// of a wedge points to the second triangle; in VTK it points away. Other kinds of cell have the
/// same order.
struct ReorderedCell {
    std::array<std::int64_t, topology::max_corners> corners;
    std::size_t num_corners;

    // Not through a span, so that a range-based for loop can take a temporary.
    const std::int64_t* begin() const { return corners.data(); }
    const std::int64_t* end() const { return corners.data() + num_corners; }
};
/// Returns the corners of a cell of the mesh in that order.
ReorderedCell with_wedges_facing_inwards(const topology::MeshData& mesh, std::size_t cell);

/// Appends "x<separator>y<separator>z", with digits that read back to the same bits.
void append_point(std::string& text, const Vec3& point, char separator = ' ');

}  // namespace incise::io
