// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_viscous_elements.h"

#include <algorithm>

#include "incise/physics/elements/viscous_kernel.h"

namespace incise::physics {

namespace plain {
AddForcesOfMemory add_forces_of_memory;
AdvanceMemory advance_memory;
}  // namespace plain
namespace avx2 {
AddForcesOfMemory add_forces_of_memory;
AdvanceMemory advance_memory;
}  // namespace avx2
namespace avx512 {
AddForcesOfMemory add_forces_of_memory;
AdvanceMemory advance_memory;
}  // namespace avx512

ViscousFunctions viscous_functions_for(Processor processor) {
    return {INCISE_CHOOSE(processor, AddForcesOfMemory, add_forces_of_memory),
            INCISE_CHOOSE(processor, AdvanceMemory, advance_memory)};
}

namespace {

const ViscousFunctions& viscous_functions() {
    static const ViscousFunctions functions = viscous_functions_for(processor());
    return functions;
}

ViscousRule rule_of(const ViscousKernel& kernel) {
    return {kernel.law, kernel.inversion_threshold, 1.0 - kernel.long_time_share, kernel.steps};
}

template <class Number>
MemoryRows<Number> rows_from(std::span<Number> first) {
    return {first.data(), first.size()};
}

}  // namespace

void SimdViscousElements::assign(std::size_t num_elements, const ViscousKernel& kernel) {
    constexpr std::size_t size = ViscousGroup::size;
    ViscousGroup unused{};
    std::fill(unused.volume, unused.volume + size, 1.0);
    groups_.elements.assign((num_elements + size - 1) / size, unused);
    groups_.fibres.assign(has_fibres(kernel.law) ? groups_.elements.size() : 0, FibreDirections{});
    groups_.shares.clear();
}

void SimdViscousElements::set(std::size_t i, ElementId id, const LinkMetric& element,
                              double share) {
    const std::size_t g = i % groups_.elements.size(), lane = i / groups_.elements.size();
    set_share(groups_.shares, groups_.elements.size(), g, lane, share);
    ViscousGroup& group = groups_.elements[g];
    for (int k = 0; k < 6; ++k) group.rest_links[k][lane] = element.rest_links[k];
    for (int k = 0; k < 9; ++k) group.inverse_edges[k][lane] = element.inverse_edges(k / 3, k % 3);
    group.volume[lane] = element.volume;
    const auto number = static_cast<std::uint32_t>(id.index());
    if (group.num_used == 0) std::fill(group.elements, group.elements + group.size, number);
    group.elements[lane] = number;
    group.num_used = std::max(group.num_used, static_cast<std::uint32_t>(lane + 1));
    if (groups_.fibres.empty()) return;
    for (int k = 0; k < 3; ++k) groups_.fibres[g].a0[k][lane] = element.fibre[k];
}

void SimdViscousElements::set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare) {
    set_offsets_of_lanes(groups_.elements, corners, spare);
}

void SimdViscousElements::add_forces(const ViscousKernel& kernel, const ViscousHistory& history,
                                     const LocalVector* positions, LocalVector* forces,
                                     std::span<const std::byte> next) const {
    viscous_functions().add_forces(rule_of(kernel), groups_, rows_from(history.of(ElementId(0))),
                                   positions, forces, next);
}

double SimdViscousElements::advance(const ViscousKernel& kernel, const LocalVector* before,
                                    const LocalVector* positions, ViscousHistory& history,
                                    FunctionRef<double(std::size_t)> advance_one) const {
    return viscous_functions().advance(rule_of(kernel), groups_,
                                       rows_from(history.of(ElementId(0))), before, positions,
                                       advance_one);
}

}  // namespace incise::physics
