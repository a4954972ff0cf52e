// Closed surfaces as rigid tools.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/cutting/tools/shapes.h"

namespace incise::cutting {

/// Makes a solid of a surface: points at the same position become one, and triangles of no area go.
/// Parts whose triangles face inwards are turned, unless they are cavities of others. See
/// fault_of() for what remains to be checked. Cost: O(n log n).
/// @param was_turned  becomes true if the triangles were turned, else false
Solid make_solid(const topology::SurfaceData& surface, bool& was_turned);

/// Returns a box about the origin.
Solid solid_of(const Cuboid& box);

/// Returns why a surface encloses no solid, with the place; empty if it does. It does if at each
/// edge two triangles meet that run along it in opposite directions, and if the triangles face
/// outwards. Cost: O(n log n).
std::string fault_of(const Solid& solid);

/// True if a point, m, is inside a closed surface whose triangles face outwards. Cost: O(n).
bool encloses(const topology::SurfaceData& surface, const Vec3& x);

/// Returns the volume inside a closed surface, m3; below 0 if its triangles face inwards.
double volume_of(const topology::SurfaceData& surface);

}  // namespace incise::cutting
