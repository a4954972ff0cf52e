// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_hybmss_elements.h"

#include <algorithm>
#include <cassert>

#include "incise/physics/elements/hybmss_kernel.h"

namespace incise::physics {

static_assert(CellGroup<double>::size == elements_together);

namespace plain {
AddHybmssForces<double> add_hybmss_forces;
AddHybmssForces<float> add_hybmss_forces;
HybmssEnergies hybmss_energies;
HybmssStates hybmss_states;
}  // namespace plain
namespace avx2 {
AddHybmssForces<double> add_hybmss_forces;
AddHybmssForces<float> add_hybmss_forces;
HybmssEnergies hybmss_energies;
HybmssStates hybmss_states;
}  // namespace avx2
namespace avx512 {
AddHybmssForces<double> add_hybmss_forces;
AddHybmssForces<float> add_hybmss_forces;
HybmssEnergies hybmss_energies;
HybmssStates hybmss_states;
}  // namespace avx512

template <class Number>
AddHybmssForces<Number>* hybmss_forces_for(Processor processor) {
    return INCISE_CHOOSE(processor, AddHybmssForces<Number>, add_hybmss_forces);
}
template AddHybmssForces<double>* hybmss_forces_for(Processor processor);
template AddHybmssForces<float>* hybmss_forces_for(Processor processor);

HybmssEnergies* hybmss_energies_for(Processor processor) {
    return INCISE_CHOOSE(processor, HybmssEnergies, hybmss_energies);
}
HybmssStates* hybmss_states_for(Processor processor) {
    return INCISE_CHOOSE(processor, HybmssStates, hybmss_states);
}

void SimdHybmssElements::assign(std::size_t num_elements, const HybmssKernel& kernel) {
    num_elements_ = num_elements;
    using Singles = std::vector<CellGroup<float>>;
    const bool is_single = kernel.precision == Precision::single_precision;
    if (is_single != std::holds_alternative<Singles>(groups_)) {
        if (is_single)
            groups_.emplace<Singles>();
        else
            groups_.emplace<std::vector<CellGroup<double>>>();
    }
    std::visit(
        [&]<class Number>(std::vector<CellGroup<Number>>& groups) {
            constexpr std::size_t size = CellGroup<Number>::size;
            CellGroup<Number> unused{};
            std::fill(unused.volume, unused.volume + size, Number{1});
            groups.assign((num_elements + size - 1) / size, unused);
        },
        groups_);
}

void SimdHybmssElements::set(std::size_t i, const HybmssElement& element,
                             [[maybe_unused]] double share) {
    assert(share == 1.0);  // ElementStore makes others cells of HEML
    std::visit(
        [&]<class Number>(std::vector<CellGroup<Number>>& groups) {
            CellGroup<Number>& group = groups[i % groups.size()];
            const std::size_t lane = i / groups.size();
            for (std::size_t g = 0; g < 7; ++g) {
                group.stiffnesses[g][lane] = static_cast<Number>(element.springs.stiffnesses[g]);
                group.rest_pulls[g][lane] = static_cast<Number>(element.springs.stiffnesses[g] *
                                                                element.springs.lengths[g]);
            }
            group.volume[lane] = static_cast<Number>(element.volume);
        },
        groups_);
}

void SimdHybmssElements::set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare) {
    std::visit([&](auto& groups) { set_offsets_of_lanes(groups, corners, spare); }, groups_);
}

void SimdHybmssElements::add_forces(const HybmssKernel& kernel, const LocalVector* positions,
                                    LocalVector* forces, std::span<const std::byte> next) const {
    std::visit(
        [&]<class Number>(const std::vector<CellGroup<Number>>& groups) {
            static AddHybmssForces<Number>* const add = hybmss_forces_for<Number>(processor());
            add(kernel.material.volume_modulus, groups, positions, forces, next);
        },
        groups_);
}

std::span<const std::byte> SimdHybmssElements::bytes() const {
    return std::visit([](const auto& groups) { return std::as_bytes(std::span(groups)); }, groups_);
}

BlockState SimdHybmssElements::state(const HybmssKernel& kernel,
                                     const LocalVector* positions) const {
    static HybmssEnergies* const compute = hybmss_energies_for(processor());
    const auto cells = groups<double>();
    const auto energies = room_for<ElementEnergies>(cells.size());
    compute(kernel.material.volume_modulus, cells, positions, energies.data());
    return state_of_block(energies, num_elements_);
}

void SimdHybmssElements::set_results(const HybmssKernel& kernel, const LocalVector* positions,
                                     std::span<ElementResult> results) const {
    static HybmssStates* const compute = hybmss_states_for(processor());
    const auto cells = groups<double>();
    const auto states = room_for<ElementStates>(cells.size());
    compute(kernel.material.volume_modulus, cells, positions, states.data());
    physics::set_results(states, results);
}

}  // namespace incise::physics
