// Surfaces in STL (.stl).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// Whether the file has exactly the size, 84 + 50 n bytes, of a binary file with the n triangles
/// that it announces. Its text may begin with anything, also with "solid" as in ascii files; a
/// text in turn would announce so many triangles that it had to be larger than 7 GB to fit.
bool is_binary_stl(const InputFile& file);

/// See read_surface. Several solids of an ascii file become one surface. Binary files are little
/// endian, as all are that are called STL.
SurfaceFile read_stl(const InputFile& file);

}  // namespace incise::io
