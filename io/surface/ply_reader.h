// Surfaces in the Polygon File Format (.ply).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// See read_surface. Version 1.0, ascii and binary of either byte order. Taken are x, y, z of the
/// element `vertex` and the list `vertex_indices` (or `vertex_index`) of the element `face`, of
/// any types and at any place among other properties and elements.
SurfaceFile read_ply(const InputFile& file);

}  // namespace incise::io
