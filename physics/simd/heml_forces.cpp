// Forces of HEML on lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/simd/gather_lanes.h"
#include "incise/physics/simd/link_forces.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

// The edges of the next elements are gathered before the forces of these are added, so that the
// processor loads them while it waits for the arithmetic. Flattened, since a function that is not
// inlined would pass its vectors through memory.
template <class Law, class Number>
[[gnu::flatten]] void add_forces(const Law& law, double J0, const LinkGroups<Number>& groups,
                                 const LocalVector* positions, LocalVector* forces,
                                 std::span<const std::byte> next) {
    const std::span<const LinkGroup<Number>> links = groups.links;
    constexpr std::size_t num_parts = LinkGroup<Number>::size / num_lanes<Number>;
    const std::size_t n = links.size() * num_parts;
    if (n == 0) return;
    const auto edges_of = [&](std::size_t part) {
        return gather_edges<Number>(positions, links[part / num_parts].offsets,
                                    part % num_parts * num_lanes<Number>);
    };
    const FetchAhead fetch_ahead(links, next);
    LinkVectors<Number> edges = edges_of(0);
    for (std::size_t part = 0; part < n; ++part) {
        const std::size_t g = part / num_parts, first = part % num_parts * num_lanes<Number>;
        fetch_ahead(g);
        const auto* const fibres = groups.fibres.empty() ? nullptr : &groups.fibres[g];
        LinkVectors<Number> f = link_forces(law, J0, links[g], fibres, first, edges);
        if (!groups.shares.empty()) {
            const auto share = Lanes<Number>::load(groups.shares[g].share + first);
            for (Lanes3<Number>& v : f) v = share * v;
        }
        edges = edges_of(std::min(part + 1, n - 1));
        scatter_add<Number>(f, forces, links[g].offsets, first);
    }
}

}  // namespace

void add_heml_forces(const Law& law, double J0, const LinkGroups<double>& groups,
                     const LocalVector* positions, LocalVector* forces,
                     std::span<const std::byte> next) {
    std::visit([&](const auto& l) { add_forces(l, J0, groups, positions, forces, next); }, law);
}

void add_heml_forces(const Law& law, double J0, const LinkGroups<float>& groups,
                     const LocalVector* positions, LocalVector* forces,
                     std::span<const std::byte> next) {
    std::visit([&](const auto& l) { add_forces(l, J0, groups, positions, forces, next); }, law);
}

}  // namespace incise::physics::INCISE_PROCESSOR
