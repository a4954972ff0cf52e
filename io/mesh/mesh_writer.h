// Writing of volume meshes: the one entry point for every format.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// Writes the mesh in the format of the path's suffix (in either case): cells in their order,
/// regions, and coordinates that read back to the same bits.
/// .vtu: VTK XML; .vtk: legacy VTK; .msh: Gmsh 2.2, regions as physical groups; .mesh: MEDIT,
/// regions as references, cells grouped by kind; .inp: Abaqus and CalculiX, regions as element
/// sets, cells grouped by region and kind (CalculiX itself has no pyramids).
/// Where points may coincide, a comment says so, which read_mesh() knows again.
/// Throws InputError if the format is not known; OutputError if the file
/// cannot be written, which is then left as it was.
void write_mesh(const std::filesystem::path& path, const topology::MeshData& mesh);

/// Throws what write_mesh() would throw at once: InputError for a suffix that is not known,
/// OutputError where there can be no such file (require_writable). To be asked before the work, so
/// that it is not done in vain.
void check_writable(const std::filesystem::path& path);

/// With their points, in alphabetical order.
std::vector<std::string> writable_suffixes();

}  // namespace incise::io
