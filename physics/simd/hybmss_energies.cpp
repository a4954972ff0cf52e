// Energies, volume ratios and virials of HybMSS on lanes. Compiled for each kind of processor:
// lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/simd/cell_lanes.h"
#include "incise/physics/simd/gather_lanes.h"
#include "incise/physics/simd/state_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

using Cells = std::span<const CellGroup<double>>;

/// Calls visit(i, j, vector from corner i to j, length, pull) for each spring. Returns the energies
/// of the springs.
///
/// The pull k (l - l0) is k l less k l0, both rounded. It is exactly zero if the spring has exactly
/// its rest length. The energy is the square of the pull over 2 k.
template <class Visit>
[[gnu::always_inline]] inline DoubleLanes visit_springs(const CellGroup<double>& group,
                                                        std::size_t first,
                                                        const std::array<DoubleLanes3, 8>& x,
                                                        Visit visit) {
    DoubleLanes energy = 0.0;
#pragma GCC unroll 7
    for (std::size_t g = 0; g < 7; ++g) {
        const DoubleLanes k = DoubleLanes::load(group.stiffnesses[g] + first),
                          at_rest = DoubleLanes::load(group.rest_pulls[g] + first);
        DoubleLanes squares = 0.0;
#pragma GCC unroll 4
        for (const auto& [i, j] : HybmssKernel::springs[g]) {
            const DoubleLanes3 v = x[j] - x[i];
            const DoubleLanes length = sqrt(rounded_dot(v, v)),
                              pull = DoubleLanes(k * length) - at_rest;
            squares += pull * pull;
            visit(i, j, v, length, pull);
        }
        // Finite for springs with k = 0, which are absent; correct for k < 0.
        constexpr double least = 1e-300;
        energy += DoubleLanes(0.5 * squares * k) / max(DoubleLanes(k * k), least);
    }
    return energy;
}

/// Stores the volume ratios, and the energies of springs and volume term. Returns the ratios.
[[gnu::always_inline]] inline DoubleLanes put_energies(double volume_modulus,
                                                       const CellGroup<double>& cells,
                                                       std::size_t first, DoubleLanes of_springs,
                                                       const BoxLanes<double>& box,
                                                       ElementEnergies& energies) {
    const DoubleLanes rest_volume = DoubleLanes::load(cells.volume + first);
    const DoubleLanes ratio = box.rounded_volume() / rest_volume, strain = ratio - 1.0;
    put(of_springs + 0.5 * volume_modulus * rest_volume * (strain * strain),
        energies.energy + first);
    put(ratio, energies.volume_ratio + first);
    return ratio;
}

/// Calls visit(number of the group, first lane, corners) for one cell per lane at a time.
template <class Visit>
[[gnu::always_inline]] inline void for_each_part(Cells groups, const LocalVector* positions,
                                                 Visit visit) {
    const FetchAhead fetch_ahead(groups, {});
    for (std::size_t g = 0; g < groups.size(); ++g) {
        fetch_ahead(g);
        for (std::size_t first = 0; first < elements_together; first += DoubleLanes::size)
            visit(g, first, gather_corners(positions, groups[g].offsets, first));
    }
}

}  // namespace

// Flattened, since a function that is not inlined would pass its vectors through memory.
[[gnu::flatten]] void hybmss_energies(double volume_modulus, Cells groups,
                                      const LocalVector* positions, ElementEnergies* energies) {
    for_each_part(groups, positions, [&](std::size_t g, std::size_t first, const auto& x) {
        const DoubleLanes of_springs = visit_springs(groups[g], first, x, [](const auto&...) {});
        put_energies(volume_modulus, groups[g], first, of_springs, BoxLanes<double>(x),
                     energies[g]);
    });
}

[[gnu::flatten]] void hybmss_states(double volume_modulus, Cells groups,
                                    const LocalVector* positions, ElementStates* states) {
    for_each_part(groups, positions, [&](std::size_t g, std::size_t first, const auto& x) {
        // Replaces a length of zero by one with a finite quotient. The spring then has no force,
        // since its vector v is zero.
        constexpr double least_length = 1e-150;
        std::array<DoubleLanes3, 8> f, edges;
        f.fill({0.0, 0.0, 0.0});
        const DoubleLanes of_springs =
            visit_springs(groups[g], first, x,
                          [&](std::size_t i, std::size_t j, const DoubleLanes3& v,
                              DoubleLanes length, DoubleLanes pull) {
                              const DoubleLanes per_length = pull / max(length, least_length);
                              f[i] = f[i] + per_length * v;
                              f[j] = f[j] - per_length * v;
                          });
        const BoxLanes<double> box(x);
        const DoubleLanes ratio =
            put_energies(volume_modulus, groups[g], first, of_springs, box, states[g]);
        if (volume_modulus != 0.0) box.add_forces(volume_modulus, ratio, f);
        for (std::size_t k = 0; k < 8; ++k) edges[k] = x[k] - x[0];
        put_virials(f, edges, states[g], first);
    });
}

}  // namespace incise::physics::INCISE_PROCESSOR
