// A point of the material as a combination of nodes of the physics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::fragments {

/// A point that a fragment carries: a combination of its corners, with weights that sum to 1. In a
/// fragment that carries material of another carrier, weights can be negative.
///
/// Positions and velocities of the point are those of the nodes, times their weights. A force or an
/// impulse at the point acts on the nodes with the same weights: its power is then the same.
struct EmbeddedPoint {
    ElementId fragment;
    std::array<NodeId, topology::max_corners> nodes{};
    std::array<double, topology::max_corners> weights{};
    int count = 0;  ///< 1 for a point at a corner of the fragment

    /// Calls visit(node, weight) for each node of the combination.
    template <class Visit>
    void for_each(Visit visit) const {
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
            visit(nodes[k], weights[k]);
    }
    /// Returns what the point has of a quantity of the nodes, such as the position.
    /// @param of_nodes  by node id
    Vec3 value(std::span<const Vec3> of_nodes) const {
        if (count == 1) return of_nodes[nodes[0].index()];
        Vec3 sum = Vec3::Zero();
        for_each([&](NodeId n, double weight) { sum += weight * of_nodes[n.index()]; });
        return sum;
    }
};

}  // namespace incise::fragments
