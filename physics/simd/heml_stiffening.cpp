// The stiffening of HEML on lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <limits>

#include "incise/physics/laws/stiffening.h"
#include "incise/physics/simd/gather_lanes.h"
#include "incise/physics/simd/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

/// Returns the strain of the part of a group that starts at lane `first`, with all invariants.
template <class Law, class Number>
[[gnu::always_inline]] inline LinkStrain<Lanes<Number>> strain_of_edges(
    const LinkGroup<Number>& group, const FibreGroup<Number>* fibres, std::size_t first,
    const LinkVectors<Number>& edges) {
    const Lanes3<Number>&v1 = edges[0], &v2 = edges[1], &v3 = edges[2];
    const std::array<Lanes3<Number>, 6> links{v1, v2, v3, v2 - v1, v3 - v2, v1 - v3};
    std::array<Lanes<Number>, 6> dl;
    for (std::size_t k = 0; k < 6; ++k)
        dl[k] = dot(links[k], links[k]) - Lanes<Number>::load(group.rest_links[k] + first);
    const Lanes<Number> J =
        dot(cross(v1, v2), v3) * Lanes<Number>::load(group.per_six_volumes + first);
    auto strain = strain_of_links<SaintVenantKirchhoff>(group, fibres, first, dl, J);
    if constexpr (HasFibres<Law>) strain.f = strain_of_links<Law>(group, fibres, first, dl, J).f;
    return strain;
}

// Flattened, since a function that is not inlined would pass its vectors through memory.
template <class Law, class Number>
[[gnu::flatten]] void set_stiffening(const Law& law, double J0, const LinkGroups<Number>& groups,
                                     const LocalVector* positions,
                                     ElementFactors<Number>* factors) {
    constexpr double rounding = std::numeric_limits<Number>::epsilon();
    const std::span<const LinkGroup<Number>> links = groups.links;
    const FetchAhead fetch_ahead(links, {});
    for (std::size_t g = 0; g < links.size(); ++g) {
        fetch_ahead(g);
        const auto* const fibres = groups.fibres.empty() ? nullptr : &groups.fibres[g];
        for (std::size_t first = 0; first < LinkGroup<Number>::size; first += num_lanes<Number>) {
            const auto edges = gather_edges<Number>(positions, links[g].offsets, first);
            const auto strain = strain_of_edges<Law>(links[g], fibres, first, edges);
            stiffening(law, strain, J0, rounding).store(factors[g].factor + first);
        }
    }
}

}  // namespace

void heml_stiffening(const Law& law, double J0, const LinkGroups<double>& groups,
                     const LocalVector* positions, ElementFactors<double>* factors) {
    std::visit([&](const auto& l) { set_stiffening(l, J0, groups, positions, factors); }, law);
}

void heml_stiffening(const Law& law, double J0, const LinkGroups<float>& groups,
                     const LocalVector* positions, ElementFactors<float>* factors) {
    std::visit([&](const auto& l) { set_stiffening(l, J0, groups, positions, factors); }, law);
}

}  // namespace incise::physics::INCISE_PROCESSOR
