// Energies, volume ratios and virials of HEML on lanes. Compiled for each kind of processor:
// lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/simd/gather_lanes.h"
#include "incise/physics/simd/link_forces.h"
#include "incise/physics/simd/state_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using DoubleGroup = LinkGroup<double>;

/// Returns the six links of the part of a group that starts at lane `first`. Each link is the
/// difference of its own corners. A difference of two edges would be rounded once more, and an
/// element at rest would have a strain.
[[gnu::always_inline]] inline std::array<DoubleLanes3, 6> gather_links(const LocalVector* positions,
                                                                       const DoubleGroup& group,
                                                                       std::size_t first) {
    const auto corners = gather_corners(positions, group.offsets, first);
    constexpr std::size_t ends[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}};
    std::array<DoubleLanes3, 6> links;
#pragma GCC unroll 6
    for (std::size_t k = 0; k < 6; ++k) links[k] = corners[ends[k][1]] - corners[ends[k][0]];
    return links;
}

const FibreGroup<double>* fibres_of(const LinkGroups<double>& groups, std::size_t g) {
    return groups.fibres.empty() ? nullptr : &groups.fibres[g];
}

/// Returns the volume ratio with the same bits as HemlKernel::volume_ratio.
DoubleLanes volume_ratio(const DoubleLanes3& v1, const DoubleLanes3& v2, const DoubleLanes3& v3,
                         DoubleLanes rest_volume) {
    return rounded_dot(rounded_cross(v1, v2), v3) / DoubleLanes(6.0) / rest_volume;
}

/// Returns the energy density of a law, by its own function for it if there is one.
template <class L>
[[gnu::always_inline]] inline DoubleLanes energy_density(const L& law,
                                                         const LinkStrain<DoubleLanes>& strain,
                                                         double J0) {
    if constexpr (requires { law.energy_density(strain, J0); })
        return law.energy_density(strain, J0);
    else
        return law.response(strain, J0).w;
}

/// Returns the strain of the part of group g that starts at lane `first`.
template <class L>
[[gnu::always_inline]] inline LinkStrain<DoubleLanes> strain_of(
    const LinkGroups<double>& groups, std::size_t g, std::size_t first,
    const std::array<DoubleLanes3, 6>& links) {
    const DoubleGroup& group = groups.links[g];
    std::array<DoubleLanes, 6> dl;
    for (std::size_t k = 0; k < 6; ++k)
        dl[k] = rounded_dot(links[k], links[k]) - DoubleLanes::load(group.rest_links[k] + first);
    return strain_of_links<L, double>(
        group, fibres_of(groups, g), first, dl,
        volume_ratio(links[0], links[1], links[2], DoubleLanes::load(group.volume + first)));
}

/// Calls visit(number of the group, first lane) for one element per lane at a time.
template <class Visit>
[[gnu::always_inline]] inline void for_each_part(std::span<const DoubleGroup> groups, Visit visit) {
    const FetchAhead fetch_ahead(groups, {});
    for (std::size_t g = 0; g < groups.size(); ++g) {
        fetch_ahead(g);
        for (std::size_t first = 0; first < DoubleGroup::size; first += num_lanes<double>)
            visit(g, first);
    }
}

// Flattened, since a function that is not inlined would pass its vectors through memory.
template <class L>
[[gnu::flatten]] void set_energies(const L& law, double J0, const LinkGroups<double>& groups,
                                   const LocalVector* positions, ElementEnergies* energies) {
    for_each_part(groups.links, [&](std::size_t g, std::size_t first) {
        const auto links = gather_links(positions, groups.links[g], first);
        const auto strain = strain_of<L>(groups, g, first, links);
        DoubleLanes volume = DoubleLanes::load(groups.links[g].volume + first);
        if (!groups.shares.empty())
            volume = DoubleLanes::load(groups.shares[g].share + first) * volume;
        put(volume * energy_density(law, strain, J0), energies[g].energy + first);
        put(strain.J, energies[g].volume_ratio + first);
    });
}

}  // namespace

void heml_energies(const Law& law, double J0, const LinkGroups<double>& groups,
                   const LocalVector* positions, ElementEnergies* energies) {
    std::visit([&](const auto& l) { set_energies(l, J0, groups, positions, energies); }, law);
}

void heml_states(const Law& law, double J0, const LinkGroups<double>& groups,
                 const LocalVector* positions, ElementStates* states) {
    std::visit(
        [&]<class L>(const L& l) {
            for_each_part(groups.links, [&](std::size_t g, std::size_t first) {
                const DoubleGroup& group = groups.links[g];
                const auto links = gather_links(positions, group, first);
                const auto strain = strain_of<L>(groups, g, first, links);
                const DoubleLanes volume = DoubleLanes::load(group.volume + first);
                ElementStates& state = states[g];
                put(volume * energy_density(l, strain, J0), state.energy + first);
                put(strain.J, state.volume_ratio + first);
                const LinkVectors<double> edges{links[0], links[1], links[2]};
                put_virials(link_forces(l, J0, group, fibres_of(groups, g), first, edges), edges,
                            state, first);
            });
        },
        law);
}

}  // namespace incise::physics::INCISE_PROCESSOR
