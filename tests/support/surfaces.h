// Closed surfaces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/base/types.h"
#include "incise/topology/surface_data.h"

namespace incise::test {

/// A sphere of 20 * 4^n triangles with their corners on it.
topology::SurfaceData icosphere(const Vec3& centre, double radius, int num_divisions);
/// Twelve triangles.
topology::SurfaceData box_surface(const Box& box);
/// The triangles of both; points stay as they are.
topology::SurfaceData joined(const topology::SurfaceData& a, const topology::SurfaceData& b);
/// The same triangles, facing the other way.
topology::SurfaceData turned(topology::SurfaceData surface);
/// The surface as an ascii STL file.
std::string stl_text(const topology::SurfaceData& surface);

}  // namespace incise::test
