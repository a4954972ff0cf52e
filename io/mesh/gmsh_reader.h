// Meshes of Gmsh (.msh).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// See read_mesh. Versions 2.x and 4.1, ascii and binary in either byte order; nodes may be
/// parametric. Regions are the physical groups of the volumes, 0 where there is none. Points are
/// numbered in the order of the file; node tags may have gaps.
MeshFile read_gmsh(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
