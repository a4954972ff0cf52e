// Meshes of MEDIT (.mesh).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a MEDIT file; see read_mesh(). Reads text of three dimensions, versions 1 to 4. Regions
/// are the references of the cells.
MeshFile read_medit(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
