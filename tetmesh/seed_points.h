// Points from which a mesh grows where a few points far apart do not begin one.
// Source: Boissonnat, Oudot 2005, Provably good sampling and meshing of surfaces, 6.1: the small
// triangles from which they begin.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <vector>

#include "incise/base/types.h"

namespace incise::tetmesh {

/// Returns two points of the surface of a region that make, with a third one, a triangle whose
/// edges are about as long as `length`, or a half or a quarter of it where the region is thin.
/// Returns none if there is no such triangle, such as at the tip of a needle.
/// @param x          the third point, on the surface of the region
/// @param region_at  the region at a point
/// Cost: some hundred calls of region_at.
std::vector<Vec3> seed_points(const Vec3& x, double length, int region,
                              const std::function<int(const Vec3&)>& region_at);

}  // namespace incise::tetmesh
