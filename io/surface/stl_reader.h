// Surfaces in STL (.stl).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// True if the file has exactly the size of a binary file, 84 + 50 n bytes, where n is the number
/// of triangles in its header. The title of a binary file may begin with any text, also with
/// "solid" as in ascii files. An ascii file read as binary would have so large an n that its size
/// could fit only above 7 GB.
bool is_binary_stl(const InputFile& file);

/// Reads an STL file; see read_surface(). Several solids of an ascii file become one surface.
/// Binary files are little endian.
SurfaceFile read_stl(const InputFile& file);

}  // namespace incise::io
