// Meshes of Gmsh (.msh).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a Gmsh file; see read_mesh(). Reads version 1, and versions 2.x and 4.1, ascii and binary
/// in either byte order. Nodes of versions 2 and 4 may be parametric. Regions are the physical
/// groups of the volumes, or 0 for a volume without a group. Points are in the order of the file.
/// Node tags may have gaps.
MeshFile read_gmsh(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
