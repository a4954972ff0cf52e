// Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstring>

#include "physics/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Scalar = Lanes<double>;
using Vector = Lanes3<double>;
using Group = LinkGroup<double>;

/// The six links of the part of a group that starts at lane `first`, each as the difference of its
/// own corners: that of two edges is rounded once more, and would leave an element at rest a
/// strain.
std::array<Vector, 6> gather_links(const LocalVector* positions, const Group& group,
                                   std::size_t first) {
    Doubles corners[4][4];  // four rows of each, as in gather_edges
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t p = 0; p < 4; ++p)
            corners[k][p] = load_quads(positions, group.nodes[k] + first + p);
    constexpr std::size_t ends[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {2, 3}, {3, 1}};
    std::array<Vector, 6> links;
#pragma GCC unroll 6
    for (std::size_t k = 0; k < 6; ++k) {
        const auto [from, to] = ends[k];
        Scalar rows[4];
        for (std::size_t p = 0; p < 4; ++p) rows[p] = corners[to][p] - corners[from][p];
        transpose(rows[0], rows[1], rows[2], rows[3]);
        links[k] = {rows[0], rows[1], rows[2]};
    }
    return links;
}

/// To the bit as HemlKernel::volume_ratio.
Scalar volume_ratio(const Vector& v1, const Vector& v2, const Vector& v3, Scalar rest_volume) {
    return rounded_dot(rounded_cross(v1, v2), v3) / Scalar(6.0) / rest_volume;
}

/// A law's w: by a function for it alone, where the law has one.
template <class L>
[[gnu::always_inline]] inline Scalar energy_density(const L& law, const LinkStrain<Scalar>& strain,
                                                    double J0) {
    if constexpr (requires { law.energy_density(strain, J0); })
        return law.energy_density(strain, J0);
    else
        return law.response(strain, J0).w;
}

/// Wherever that lies: vectors are aligned to a number only.
void put(Scalar values, double* to) { std::memcpy(to, &values.v, sizeof(values.v)); }

/// Calls visit(group's number, first lane) for as many elements at a time as there are lanes.
template <class Visit>
[[gnu::always_inline]] inline void for_each_part(std::span<const Group> groups, Visit visit) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
        fetch_ahead(groups, g);
        for (std::size_t first = 0; first < Group::size; first += num_lanes<double>)
            visit(g, first);
    }
}

}  // namespace

void heml_energies(const Law& law, double J0, const LinkGroups<double>& groups,
                   const LocalVector* positions, double* energies) {
    std::visit(
        [&]<class L>(const L& l) {
            for_each_part(groups.links, [&](std::size_t g, std::size_t first) {
                const Group& group = groups.links[g];
                const auto links = gather_links(positions, group, first);
                std::array<Scalar, 6> dl;
                for (std::size_t k = 0; k < 6; ++k)
                    dl[k] =
                        rounded_dot(links[k], links[k]) - Scalar::load(group.rest_links[k] + first);
                const Scalar volume = Scalar::load(group.volume + first);
                const StrainedLinks<L, double> strained(
                    group, groups.fibres.empty() ? nullptr : &groups.fibres[g], first, dl,
                    volume_ratio(links[0], links[1], links[2], volume));
                const Scalar energy = volume * energy_density(l, strained.strain, J0);
                put(energy, energies + g * Group::size + first);
            });
        },
        law);
}

void heml_volume_ratios(const LinkGroups<double>& groups, const LocalVector* positions,
                        double* ratios) {
    for_each_part(groups.links, [&](std::size_t g, std::size_t first) {
        const Group& group = groups.links[g];
        const auto [v1, v2, v3] = gather_edges<double>(positions, group.nodes, first);
        put(volume_ratio(v1, v2, v3, Scalar::load(group.volume + first)),
            ratios + g * Group::size + first);
    });
}

}  // namespace incise::physics::INCISE_PROCESSOR
