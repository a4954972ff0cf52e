// Surfaces in the Polygon File Format (.ply).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// Reads a PLY file of version 1.0, ascii or binary in either byte order; see read_surface(). Reads
/// x, y, z of the element `vertex`, and the list `vertex_indices` (or `vertex_index`) of the
/// element `face`. Skips other properties and elements. Coordinates may have any type, and indices
/// any integer type.
SurfaceFile read_ply(const InputFile& file);

}  // namespace incise::io
