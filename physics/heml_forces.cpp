// Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

template <class Number>
void add_forces(const Law& law, double J0, const LinkGroups<Number>& groups,
                const LocalVector* positions, LocalVector* forces) {
    std::visit(
        [&](const auto& l) {
            for (std::size_t g = 0; g < groups.links.size(); ++g) {
                fetch_ahead(std::span<const LinkGroup<Number>>(groups.links), g);
                for (std::size_t first = 0; first < LinkGroup<Number>::size;
                     first += num_lanes<Number>) {
                    const LinkGroup<Number>& group = groups.links[g];
                    const auto edges = gather_edges<Number>(positions, group.nodes, first);
                    const auto f = link_forces(l, J0, group,
                                               groups.fibres.empty() ? nullptr : &groups.fibres[g],
                                               first, edges);
                    scatter_add<Number>(f, forces, group.nodes, first);
                }
            }
        },
        law);
}

}  // namespace

void add_heml_forces(const Law& law, double J0, const LinkGroups<double>& groups,
                     const LocalVector* positions, LocalVector* forces) {
    add_forces(law, J0, groups, positions, forces);
}

void add_heml_forces(const Law& law, double J0, const LinkGroups<float>& groups,
                     const LocalVector* positions, LocalVector* forces) {
    add_forces(law, J0, groups, positions, forces);
}

}  // namespace incise::physics::INCISE_PROCESSOR
