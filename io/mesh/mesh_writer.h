// Writing of volume meshes: the one entry point for every format.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::io {

/// Writes the cells in their order, the regions, and the coordinates with digits that read back to
/// the same bits. The suffix of the path, in upper or lower case, decides the format:
/// - .vtu: VTK XML
/// - .vtk: legacy VTK
/// - .msh: Gmsh 2.2, with regions as physical groups
/// - .mesh: MEDIT, with regions as references and cells grouped by kind
/// - .inp: Abaqus and CalculiX, with regions as element sets and cells grouped by region and kind.
///   CalculiX itself has no pyramids.
/// - .usda: USD as text, with regions other than 0 as subsets; tetrahedra alone
///
/// If points may coincide, a comment says so. read_mesh() recognizes this comment.
/// Throws InputError if the format is not known, or has no place for a kind of cell of the mesh.
/// Throws OutputError if the file cannot be written; its contents then do not change.
void write_mesh(const std::filesystem::path& path, const topology::MeshData& mesh);

/// Returns a warning of what the format of the path cannot contain, and write_mesh() leaves out:
/// the carriers of a cut body, unless the format is .vtu. There is none if write_mesh() refuses the
/// mesh.
/// @pre  check_writable() has passed
std::optional<std::string> loss_in_format(const std::filesystem::path& path,
                                          const topology::MeshData& mesh);

/// Checks in advance whether write_mesh() can write the file. Throws InputError for an unknown
/// suffix, and OutputError as require_writable() does.
void check_writable(const std::filesystem::path& path);

/// Returns the suffixes that write_mesh() knows, each with its dot, in alphabetical order.
std::vector<std::string> writable_suffixes();

}  // namespace incise::io
