// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/simd_heml_elements.h"

#include <algorithm>

#include "incise/physics/elements/heml_kernel.h"

namespace incise::physics {

static_assert(LinkGroup<double>::size == elements_together);

namespace plain {
AddHemlForces<double> add_heml_forces;
AddHemlForces<float> add_heml_forces;
HemlEnergies heml_energies;
HemlStates heml_states;
HemlStiffening<double> heml_stiffening;
HemlStiffening<float> heml_stiffening;
}  // namespace plain
namespace avx2 {
AddHemlForces<double> add_heml_forces;
AddHemlForces<float> add_heml_forces;
HemlEnergies heml_energies;
HemlStates heml_states;
HemlStiffening<double> heml_stiffening;
HemlStiffening<float> heml_stiffening;
}  // namespace avx2
namespace avx512 {
AddHemlForces<double> add_heml_forces;
AddHemlForces<float> add_heml_forces;
HemlEnergies heml_energies;
HemlStates heml_states;
HemlStiffening<double> heml_stiffening;
HemlStiffening<float> heml_stiffening;
}  // namespace avx512

template <class Number>
AddHemlForces<Number>* heml_forces_for(Processor processor) {
    return INCISE_CHOOSE(processor, AddHemlForces<Number>, add_heml_forces);
}
template AddHemlForces<double>* heml_forces_for(Processor processor);
template AddHemlForces<float>* heml_forces_for(Processor processor);

template <class Number>
HemlStiffening<Number>* heml_stiffening_for(Processor processor) {
    return INCISE_CHOOSE(processor, HemlStiffening<Number>, heml_stiffening);
}
template HemlStiffening<double>* heml_stiffening_for(Processor processor);
template HemlStiffening<float>* heml_stiffening_for(Processor processor);

HemlEnergies* heml_energies_for(Processor processor) {
    return INCISE_CHOOSE(processor, HemlEnergies, heml_energies);
}
HemlStates* heml_states_for(Processor processor) {
    return INCISE_CHOOSE(processor, HemlStates, heml_states);
}

template <class Number>
void set_metric(MetricGroup<Number>& group, std::size_t lane, const Eigen::Matrix3d& inverse_edges,
                double volume) {
    // (V^T V)^-1 is computed from V^-1. To invert the product would square the loss of accuracy in
    // needles.
    const auto product = [&](int a, int b) {
        return inverse_edges.row(a).dot(inverse_edges.row(b));
    };
    const double G[] = {product(0, 0), product(1, 1), product(2, 2),
                        product(0, 1), product(1, 2), product(2, 0)};
    for (int k = 0; k < 6; ++k) group.G[k][lane] = static_cast<Number>(G[k]);
    group.volume[lane] = static_cast<Number>(volume);
    group.per_six_volumes[lane] = static_cast<Number>(1.0 / (6.0 * volume));
}
template void set_metric(MetricGroup<double>&, std::size_t, const Eigen::Matrix3d&, double);
template void set_metric(MetricGroup<float>&, std::size_t, const Eigen::Matrix3d&, double);

namespace {

template <class Number>
void assign_groups(LinkGroups<Number>& groups, std::size_t num_elements, bool has_fibres) {
    constexpr std::size_t size = LinkGroup<Number>::size;
    LinkGroup<Number> unused{};
    std::fill(unused.volume, unused.volume + size, Number{1});
    std::fill(unused.per_six_volumes, unused.per_six_volumes + size, Number{1});
    groups.links.assign((num_elements + size - 1) / size, unused);
    groups.fibres.assign(has_fibres ? groups.links.size() : 0, FibreGroup<Number>{});
    groups.shares.clear();
}

template <class Number>
void set_element(LinkGroups<Number>& groups, std::size_t i, const LinkMetric& element,
                 double share) {
    const std::size_t g = i % groups.links.size(), lane = i / groups.links.size();
    set_share(groups.shares, groups.links.size(), g, lane, share);
    LinkGroup<Number>& group = groups.links[g];
    for (int k = 0; k < 6; ++k)
        group.rest_links[k][lane] = static_cast<Number>(element.rest_links[k]);
    set_metric(group, lane, element.inverse_edges, element.volume);
    if (groups.fibres.empty()) return;
    const Vec3 u = element.inverse_edges * element.fibre;
    for (int k = 0; k < 3; ++k) groups.fibres[g].u[k][lane] = static_cast<Number>(u[k]);
}

}  // namespace

void SimdHemlElements::assign(std::size_t num_elements, const HemlKernel& kernel) {
    num_elements_ = num_elements;
    const bool is_single = kernel.precision == Precision::single_precision;
    if (is_single != std::holds_alternative<LinkGroups<float>>(groups_)) {
        if (is_single)
            groups_.emplace<LinkGroups<float>>();
        else
            groups_.emplace<LinkGroups<double>>();
    }
    std::visit([&](auto& groups) { assign_groups(groups, num_elements, has_fibres(kernel.law)); },
               groups_);
}

void SimdHemlElements::set(std::size_t i, const LinkMetric& element, double share) {
    std::visit([&](auto& groups) { set_element(groups, i, element, share); }, groups_);
}

void SimdHemlElements::set_nodes(std::span<const std::uint16_t> corners, std::uint16_t spare) {
    std::visit([&](auto& groups) { set_offsets_of_lanes(groups.links, corners, spare); }, groups_);
}

void SimdHemlElements::add_forces(const HemlKernel& kernel, const LocalVector* positions,
                                  LocalVector* forces, std::span<const std::byte> next) const {
    std::visit(
        [&]<class Number>(const LinkGroups<Number>& groups) {
            static AddHemlForces<Number>* const add = heml_forces_for<Number>(processor());
            add(kernel.law, kernel.inversion_threshold, groups, positions, forces, next);
        },
        groups_);
}

std::span<const std::byte> SimdHemlElements::bytes() const {
    return std::visit([](const auto& groups) { return std::as_bytes(std::span(groups.links)); },
                      groups_);
}

BlockState SimdHemlElements::state(const HemlKernel& kernel, const LocalVector* positions) const {
    static HemlEnergies* const compute = heml_energies_for(processor());
    const auto& groups = std::get<LinkGroups<double>>(groups_);
    const auto energies = room_for<ElementEnergies>(groups.links.size());
    compute(kernel.law, kernel.inversion_threshold, groups, positions, energies.data());
    return state_of_block(energies, num_elements_);
}

void SimdHemlElements::set_results(const HemlKernel& kernel, const LocalVector* positions,
                                   std::span<ElementResult> results) const {
    static HemlStates* const compute = heml_states_for(processor());
    const auto& groups = std::get<LinkGroups<double>>(groups_);
    const auto states = room_for<ElementStates>(groups.links.size());
    compute(kernel.law, kernel.inversion_threshold, groups, positions, states.data());
    physics::set_results(states, results);
}

void SimdHemlElements::set_stiffening(const HemlKernel& kernel, const LocalVector* positions,
                                      std::span<double> factors) const {
    std::visit(
        [&]<class Number>(const LinkGroups<Number>& groups) {
            static HemlStiffening<Number>* const compute = heml_stiffening_for<Number>(processor());
            const auto of_groups = room_for<ElementFactors<Number>>(groups.links.size());
            compute(kernel.law, kernel.inversion_threshold, groups, positions, of_groups.data());
            std::size_t i = 0;
            for (std::size_t lane = 0; i < factors.size(); ++lane)
                for (std::size_t g = 0; g < of_groups.size() && i < factors.size(); ++g)
                    factors[i++] = static_cast<double>(of_groups[g].factor[lane]);
        },
        groups_);
}

}  // namespace incise::physics
