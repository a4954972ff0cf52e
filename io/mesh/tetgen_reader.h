// Meshes of TetGen (.node and .ele).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// See read_mesh. `file` is either one of the pair; the other one lies beside it under the same
/// name. Nodes are numbered in the order of the file; their indices may begin anywhere and have
/// gaps. Regions are the first attribute of the elements, 0 where there is none.
MeshFile read_tetgen(const InputFile& file, const ReadOptions& options);

/// The same of both files of the pair.
MeshFile read_tetgen_pair(const InputFile& nodes, const InputFile& elements);

}  // namespace incise::io
