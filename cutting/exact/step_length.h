// How large a time step an element's shape allows, and what cuts leave of it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <map>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// The stable step of a tetrahedron whose nodes have no other element, times the speed of waves in
/// it: 1 / sqrt(max_i (1/h_i) sum_j (1/h_j)), h the altitudes, m. A body's stable step
/// (physics::StableStep) is never below the least of its elements': masses and stiffnesses of a
/// node are sums over its elements.
double element_step_length(const std::array<Vec3, 4>& corners);

/// The bound of physics::StableStep at rest for a body of tetrahedra of one material, times the
/// speed of waves in it, m. Infinite without elements. Cost: O(n).
double step_length(const topology::Mesh& mesh);

/// What limits of cuts are shares of: the body at rest before the first of them.
struct UncutBody {
    /// Mean over its edges, m.
    double edge_length = std::numeric_limits<double>::infinity();
    /// By region, the body's stable step times the speed of waves in the region, m. Elements of
    /// regions that are not named may become as small as the cut leaves them.
    std::map<int, double> step_length;
    static void archive(auto& ar, auto& self) { ar(self.edge_length, self.step_length); }
};

/// Mean length at rest over all edges, m; infinite without any. Cost: O(n log n).
double mean_edge_length(const topology::Mesh& mesh);

/// Of a mesh of tetrahedra of one material. Cost: O(n log n).
UncutBody uncut_body(const topology::Mesh& mesh);

}  // namespace incise::cutting
