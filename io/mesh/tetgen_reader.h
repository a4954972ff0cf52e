// Meshes of TetGen (.node and .ele).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a pair of TetGen files; see read_mesh(). `file` is one of the pair. The other one is in
/// the same folder, under the same name. Nodes are in the order of the file. Their indices may
/// begin at any number and have gaps. Regions are the first attribute of the elements, or 0 if they
/// have none.
MeshFile read_tetgen(const InputFile& file, const ReadOptions& options);

/// The same, with both files given.
MeshFile read_tetgen_pair(const InputFile& nodes, const InputFile& elements,
                          const ReadOptions& options = {});

}  // namespace incise::io
