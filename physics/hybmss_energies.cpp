// Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/cell_lanes.h"
#include "physics/state_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Cells = std::span<const CellGroup<double>>;

/// What a spring pulls with, k (l - l0), is k l, rounded, less the rounded pull at rest: nothing if
/// it has its rest length to the bit. Its energy is the square of that over 2 k.
/// @param visit  called with a spring's ends, corners i and j, the way there, its length, and pull
/// Returns the springs' energies.
template <class Visit>
[[gnu::always_inline]] inline DoubleLanes visit_springs(const CellGroup<double>& group,
                                                        std::size_t first,
                                                        const std::array<DoubleLanes3, 8>& x,
                                                        Visit visit) {
    constexpr double least = 1e-300;  // in place of the stiffness of springs that have none
    DoubleLanes energy = 0.0;
#pragma GCC unroll 7
    for (std::size_t g = 0; g < 7; ++g) {
        const DoubleLanes k = DoubleLanes::load(group.stiffnesses[g] + first),
                          at_rest = DoubleLanes::load(group.rest_pulls[g] + first);
        DoubleLanes squares = 0.0;
#pragma GCC unroll 4
        for (const auto& [i, j] : HybmssKernel::springs[g]) {
            const DoubleLanes3 v = x[j] - x[i];
            const DoubleLanes length = sqrt(dot(v, v)), pull = DoubleLanes(k * length) - at_rest;
            squares += pull * pull;
            visit(i, j, v, length, pull);
        }
        energy += 0.5 * squares / max(k, least);
    }
    return energy;
}

/// With the volume term's.
[[gnu::always_inline]] inline void put_energies(double volume_modulus, DoubleLanes of_springs,
                                                DoubleLanes volume, DoubleLanes rest_volume,
                                                ElementEnergies& group, std::size_t first) {
    const DoubleLanes ratio = volume / rest_volume, strain = ratio - 1.0;
    put(of_springs + 0.5 * volume_modulus * rest_volume * (strain * strain), group.energy + first);
    put(ratio, group.volume_ratio + first);
}

/// Calls visit(group's number, first lane, corners) for as many cells at a time as there are lanes.
template <class Visit>
[[gnu::always_inline]] inline void for_each_part(Cells groups, const LocalVector* positions,
                                                 Visit visit) {
    const FetchAhead fetch_ahead(groups, {});
    for (std::size_t g = 0; g < groups.size(); ++g) {
        fetch_ahead(g);
        for (std::size_t first = 0; first < elements_together; first += DoubleLanes::size)
            visit(g, first, gather_cells(positions, groups[g], first));
    }
}

}  // namespace

// Flattened, as what is not inlined would have its vectors go through memory.
[[gnu::flatten]] void hybmss_energies(double volume_modulus, Cells groups,
                                      const LocalVector* positions, ElementEnergies* energies) {
    for_each_part(groups, positions, [&](std::size_t g, std::size_t first, const auto& x) {
        const DoubleLanes of_springs = visit_springs(groups[g], first, x, [](const auto&...) {});
        const DoubleLanes rest_volume = DoubleLanes::load(groups[g].volume + first);
        put_energies(volume_modulus, of_springs, BoxLanes(x).volume, rest_volume, energies[g],
                     first);
    });
}

[[gnu::flatten]] void hybmss_states(double volume_modulus, Cells groups,
                                    const LocalVector* positions, ElementStates* states) {
    for_each_part(groups, positions, [&](std::size_t g, std::size_t first, const auto& x) {
        constexpr double least = 1e-300;  // in place of the length of springs that have none
        std::array<DoubleLanes3, 8> f;
        f.fill({0.0, 0.0, 0.0});
        const DoubleLanes of_springs =
            visit_springs(groups[g], first, x,
                          [&](std::size_t i, std::size_t j, const DoubleLanes3& v,
                              DoubleLanes length, DoubleLanes pull) {
                              const DoubleLanes per_length = pull / max(length, least);
                              f[i] = f[i] + per_length * v;
                              f[j] = f[j] - per_length * v;
                          });
        const DoubleLanes rest_volume = DoubleLanes::load(groups[g].volume + first);
        const BoxLanes<double> box(x);
        if (volume_modulus != 0.0) box.add_forces(volume_modulus, rest_volume, f);
        put_energies(volume_modulus, of_springs, box.volume, rest_volume, states[g], first);
        put_virials(f, x, states[g], first);
    });
}

}  // namespace incise::physics::INCISE_PROCESSOR
