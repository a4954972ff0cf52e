// Unstructured grids in VTK's XML format (.vtu).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a .vtu file; see read_mesh(). Encodings: ascii, base64 inline or appended, raw appended;
/// plain or compressed with zlib, LZ4 or LZMA. Several pieces are put one after the other, without
/// merging their points.
MeshFile read_vtu(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
