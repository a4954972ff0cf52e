// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/mass_springs.h"

#include <algorithm>
#include <map>

namespace incise::bench {

MassSprings::MassSprings(double young, std::span<const Nodes> tetrahedra,
                         std::span<const Vec3> rest_positions) {
    std::map<std::array<std::uint32_t, 2>, Spring> by_ends;
    const physics::MassSpringKernel kernel{young};
    for (const Nodes& nodes : tetrahedra) {
        const auto element = kernel.precompute(corners_of(nodes, rest_positions));
        for (std::size_t k = 0; k < 6; ++k) {
            const auto [i, j] = physics::MassSpringKernel::edges[k];
            const auto [a, b] = std::minmax(nodes[i], nodes[j]);
            by_ends.try_emplace({a, b}, Spring{a, b, 0.0, element.rest_lengths[k]})
                .first->second.stiffness += element.stiffnesses[k];
        }
    }
    for (const auto& [ends, spring] : by_ends) springs_.push_back(spring);
}

}  // namespace incise::bench
