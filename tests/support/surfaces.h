// Closed surfaces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"
#include "incise/topology/surface_data.h"

namespace incise::test {

/// A sphere of 20 * 4^n triangles with their corners on it.
topology::SurfaceData icosphere(const Vec3& centre, double radius, int num_divisions);
/// Twelve triangles.
topology::SurfaceData box_surface(const Box& box);

}  // namespace incise::test
