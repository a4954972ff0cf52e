// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/hybmss_lanes.h"

#include <algorithm>

#include "physics/hybmss_kernel.h"

namespace incise::physics {

namespace plain {
AddHybmssForces add_hybmss_forces;
}
#ifdef INCISE_HAS_AVX
namespace avx2 {
AddHybmssForces add_hybmss_forces;
}
namespace avx512 {
AddHybmssForces add_hybmss_forces;
}
#endif

AddHybmssForces* hybmss_forces_for([[maybe_unused]] Processor processor) {
#ifdef INCISE_HAS_AVX
    if (processor == Processor::avx512) return avx512::add_hybmss_forces;
    if (processor == Processor::avx2) return avx2::add_hybmss_forces;
#endif
    return plain::add_hybmss_forces;
}

void HybmssLanes::assign(std::size_t num_elements, std::uint16_t spare, const HybmssKernel&) {
    constexpr std::size_t size = CellGroup::size;
    CellGroup unused{};
    for (auto& corner : unused.nodes) std::fill(corner, corner + size, spare);
    std::fill(unused.volume, unused.volume + size, 1.0);
    groups_.assign((num_elements + size - 1) / size, unused);
}

void HybmssLanes::set(std::size_t i, const HybmssElement& element,
                      std::span<const std::uint16_t, 8> nodes) {
    CellGroup& group = groups_[i % groups_.size()];
    const std::size_t lane = i / groups_.size();
    for (std::size_t g = 0; g < 7; ++g) {
        group.stiffnesses[g][lane] = element.springs.stiffnesses[g];
        group.lengths[g][lane] = element.springs.lengths[g];
    }
    group.volume[lane] = element.volume;
    for (std::size_t k = 0; k < 8; ++k) group.nodes[k][lane] = nodes[k];
}

void HybmssLanes::add_forces(const HybmssKernel& kernel, const LocalVector* positions,
                             LocalVector* forces) const {
    static AddHybmssForces* const add = hybmss_forces_for(processor());
    add(kernel.material.volume_modulus, groups_, positions, forces);
}

}  // namespace incise::physics
