// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/element_states.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace incise::physics {

BlockState state_of_block(std::span<ElementEnergies> groups, std::size_t num_elements) {
    BlockState state;
    const std::size_t num_groups = groups.size();
    for (std::size_t i = num_elements; i < num_groups * elements_together; ++i) {
        ElementEnergies& group = groups[i % num_groups];
        group.energy[i / num_groups] = 0.0;
        group.volume_ratio[i / num_groups] = state.min_volume_ratio;
    }
    Sums<elements_together> energies;
    std::array<double, elements_together> least;
    least.fill(state.min_volume_ratio);
    for (const ElementEnergies& group : groups) {
        Sums<elements_together>::Terms terms;
        std::memcpy(&terms, group.energy, sizeof terms);
        energies += terms;
        for (std::size_t lane = 0; lane < elements_together; ++lane)
            least[lane] = std::min(least[lane], group.volume_ratio[lane]);
    }
    for (std::size_t lane = 0; lane < elements_together; ++lane)
        state.elastic_energy += energies[lane];
    state.min_volume_ratio = *std::min_element(least.begin(), least.end());
    return state;
}

void set_results(std::span<const ElementStates> groups, std::span<ElementResult> results) {
    for (std::size_t i = 0; i < results.size(); ++i) {
        const ElementStates& group = groups[i % groups.size()];
        const std::size_t lane = i / groups.size();
        results[i].energy = group.energy[lane];
        results[i].volume_ratio = group.volume_ratio[lane];
        Eigen::Matrix3d virial;
        for (std::size_t k = 0; k < 9; ++k)
            virial(static_cast<Eigen::Index>(k / 3), static_cast<Eigen::Index>(k % 3)) =
                group.virial[k][lane];
        results[i].set_stress(virial);
    }
}

}  // namespace incise::physics
