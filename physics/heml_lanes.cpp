// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/heml_lanes.h"

#include <algorithm>

#include "physics/heml_kernel.h"

namespace incise::physics {

namespace plain {
AddHemlForces add_heml_forces;
}
#ifdef INCISE_HAS_AVX
namespace avx2 {
AddHemlForces add_heml_forces;
}
namespace avx512 {
AddHemlForces add_heml_forces;
}
#endif

AddHemlForces* heml_forces_for([[maybe_unused]] Processor processor) {
#ifdef INCISE_HAS_AVX
    if (processor == Processor::avx512) return avx512::add_heml_forces;
    if (processor == Processor::avx2) return avx2::add_heml_forces;
#endif
    return plain::add_heml_forces;
}

void HemlLanes::assign(std::size_t num_elements, std::uint16_t spare, const HemlKernel& kernel) {
    constexpr std::size_t size = LinkGroup::size;
    LinkGroup unused{};
    for (auto& corner : unused.nodes) std::fill(corner, corner + size, spare);
    std::fill(unused.volume, unused.volume + size, 1.0);
    groups_.assign((num_elements + size - 1) / size, unused);
    fibres_.assign(has_fibres(kernel.law) ? groups_.size() : 0, FibreGroup{});
}

void HemlLanes::set(std::size_t i, const LinkElement& element,
                    std::span<const std::uint16_t, 4> nodes) {
    const std::size_t g = i % groups_.size(), lane = i / groups_.size();
    LinkGroup& group = groups_[g];
    for (int k = 0; k < 6; ++k) group.rest_links[k][lane] = element.rest_links[k];
    // vtr holds G: of links between corners i and j, neither of them 0, -G_ij; of link 0i the sum
    // of G's row i.
    const Vec6& t = element.vtr;
    const double G[] = {
        t[0] + t[3] + t[5], t[1] + t[3] + t[4], t[2] + t[4] + t[5], -t[3], -t[4], -t[5]};
    for (int k = 0; k < 6; ++k) group.G[k][lane] = G[k];
    group.volume[lane] = element.volume;
    for (std::size_t k = 0; k < 4; ++k) group.nodes[k][lane] = nodes[k];
    if (fibres_.empty()) return;
    for (int k = 0; k < 3; ++k) fibres_[g].u[k][lane] = element.fibre_components[k];
}

void HemlLanes::add_forces(const HemlKernel& kernel, const LocalVector* positions,
                           LocalVector* forces) const {
    static AddHemlForces* const add = heml_forces_for(processor());
    add(kernel.law, kernel.inversion_threshold, groups_, fibres_, positions, forces);
}

}  // namespace incise::physics
