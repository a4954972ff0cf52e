// Surfaces in Wavefront OBJ (.obj).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// See read_surface. Faces may come before their points, and count points from the start of the
/// file or back from the face. All objects and groups become one surface. Free-form curves and
/// surfaces are refused.
SurfaceFile read_obj(const InputFile& file);

}  // namespace incise::io
