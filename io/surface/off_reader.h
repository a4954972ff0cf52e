// Surfaces in the Object File Format (.off).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// See read_surface. OFF as text, with or without texture coordinates (ST), colours (C) and
/// normals (N) behind the points; points of other than three dimensions are refused.
SurfaceFile read_off(const InputFile& file);

}  // namespace incise::io
