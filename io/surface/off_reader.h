// Surfaces in the Object File Format (.off).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// Reads an OFF file as text; see read_surface(). Texture coordinates (ST), colours (C) and normals
/// (N) may follow the coordinates of a point. Throws InputError also for points of other than three
/// dimensions.
SurfaceFile read_off(const InputFile& file);

}  // namespace incise::io
