// How large a time step an element's shape allows.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <map>

#include "topology/mesh.h"
#include "topology/types.h"

namespace incise::cutting {

/// The stable step of a tetrahedron whose nodes have no other element, times the speed of waves in
/// it: 1 / sqrt(max_i (1/h_i) sum_j (1/h_j)), h the altitudes, m. A body's stable step
/// (physics::StableStep) is never below the least of its elements': masses and stiffnesses of a
/// node are sums over its elements.
double own_step_length(const std::array<Vec3, 4>& corners);

/// The bound of physics::StableStep at rest for a body of tetrahedra of one material, times the
/// speed of waves in it, m. Infinite without elements. Cost: O(n).
double step_length(const topology::Mesh& mesh);

/// The limits by which cuts leave a body at least a share of its stable step, however many there
/// are: that share is 2.5 times what nodes may be off the surface, and at most a half.
/// @param step_length  by region: the body's stable step before the first cut times the speed of
///                     waves in the region
std::map<int, double> min_step_lengths(double snap, const std::map<int, double>& step_length);

}  // namespace incise::cutting
