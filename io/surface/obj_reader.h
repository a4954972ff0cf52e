// Surfaces in Wavefront OBJ (.obj).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// Reads an OBJ file; see read_surface(). A face may come before its points. It numbers points from
/// the start of the file, or backwards from the face. All objects and groups become one surface.
/// Throws InputError also for free-form curves and surfaces.
SurfaceFile read_obj(const InputFile& file);

}  // namespace incise::io
