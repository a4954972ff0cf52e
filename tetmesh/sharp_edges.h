// Lines along the sharp edges of surfaces.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/surface_parts.h"

namespace incise::tetmesh {

/// Returns lines along the edges at which the surfaces turn by at least an angle, rad. A line ends
/// where three sharp edges meet, where it turns by that angle itself, and where it meets or crosses
/// another one. Lines of surfaces that touch become one where they coincide.
/// Cost: O(n log n), and O(s^2) for s sharp edges of surfaces of several parts.
std::vector<std::vector<Vec3>> sharp_edges(const std::vector<topology::SurfaceParts>& surfaces,
                                           double angle);

}  // namespace incise::tetmesh
