// Unstructured grids in VTK's legacy format (.vtk).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// See read_mesh. Versions 1 to 5.x, ascii and binary; binary data are big-endian by definition,
/// and `long` has 64 bits. Arrays of type `variant` cannot be read, nor skipped.
MeshFile read_legacy_vtk(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
