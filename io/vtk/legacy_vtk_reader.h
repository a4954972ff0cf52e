// Unstructured grids in VTK's legacy format (.vtk).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a legacy VTK file of version 1 to 5.x, ascii or binary; see read_mesh(). Binary data are
/// big-endian by definition, and `long` has 64 bits. Throws InputError also if there is an array of
/// an unknown type, such as `variant`, which cannot be skipped.
MeshFile read_legacy_vtk(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
