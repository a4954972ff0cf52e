// The length of time step that the shape of elements allows. Cuts keep a share of it:
// docs/cutting.md, Slivers, and the step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <limits>
#include <map>

#include "incise/base/types.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Returns the element stable step of a tetrahedron times the speed of waves in it, m:
///     1 / sqrt(max_i (1/h_i) sum_j (1/h_j)), with the altitudes h.
/// The stable step of a body (physics::StableStep) is never below the least of these, since masses
/// and stiffnesses of a node are sums over its elements.
double element_step_length(const std::array<Vec3, 4>& corners);

/// Returns the stable step of a body of tetrahedra of one material at rest (physics::StableStep),
/// times the speed of waves in it, m. Returns infinity if there are no tetrahedra. Cost: O(n).
double step_length(const topology::Mesh& mesh);

/// The body at rest before its first cut. Limits of cuts are shares of these values.
struct UncutBody {
    /// Mean over the edges of the body, m.
    double edge_length = std::numeric_limits<double>::infinity();
    /// By region: the stable step of the body times the speed of waves in the region, m. Elements
    /// of other regions may become as small as the cut makes them.
    std::map<int, double> step_length;
    static void archive(auto& ar, auto& self) { ar(self.edge_length, self.step_length); }
};

/// Returns the mean length of all edges at rest, m, or infinity if there are none.
/// Cost: O(n log n).
double mean_edge_length(const topology::Mesh& mesh);

/// Returns the values of a mesh of tetrahedra of one material. Cost: O(n log n).
UncutBody uncut_body(const topology::Mesh& mesh);

}  // namespace incise::cutting
