// Forces of HybMSS on lanes. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/simd/cell_lanes.h"
#include "incise/physics/simd/gather_lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

/// Adds the forces of the part of a group that starts at lane `first`; see HybmssKernel::forces.
template <class Number>
[[gnu::always_inline]] inline void add_forces_of(double volume_modulus,
                                                 const CellGroup<Number>& group, std::size_t first,
                                                 const LocalVector* positions,
                                                 LocalVector* forces) {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    const auto load = [first](const auto& row) { return Scalar::load(row + first); };
    // Corners are relative to corner 0. Its force follows from those of the others.
    std::array<Vector, 8> x, f;
    x.fill({0.0, 0.0, 0.0});
    f = x;
    const auto edges = gather_edges<Number>(positions, group.offsets, first);
    std::copy(edges.begin(), edges.end(), x.begin() + 1);
#pragma GCC unroll 7
    for (std::size_t g = 0; g < 7; ++g) {
        const Scalar k = load(group.stiffnesses[g]), at_rest = load(group.rest_pulls[g]);
#pragma GCC unroll 4
        for (const auto& [i, j] : HybmssKernel::springs[g]) {
            const Vector v = x[j] - x[i];
            // Finite also for v = 0, so that a spring without length has no force.
            const Scalar pull = k - at_rest * reciprocal_sqrt(dot(v, v));
            f[i] = f[i] + pull * v;
            f[j] = f[j] - pull * v;
        }
    }
    if (volume_modulus != 0.0) {
        const BoxLanes<Number> box(x);
        box.add_forces(volume_modulus, box.volume() / load(group.volume), f);
    }
    std::array<Vector, 7> others;
    std::copy(f.begin() + 1, f.end(), others.begin());
    scatter_add<Number>(others, forces, group.offsets, first);
}

template <class Number>
[[gnu::flatten]] void add_forces(double volume_modulus, std::span<const CellGroup<Number>> groups,
                                 const LocalVector* positions, LocalVector* forces,
                                 std::span<const std::byte> next) {
    const FetchAhead fetch_ahead(groups, next);
    for (std::size_t g = 0; g < groups.size(); ++g) {
        fetch_ahead(g);
        for (std::size_t first = 0; first < CellGroup<Number>::size; first += num_lanes<Number>)
            add_forces_of(volume_modulus, groups[g], first, positions, forces);
    }
}

}  // namespace

void add_hybmss_forces(double volume_modulus, std::span<const CellGroup<double>> groups,
                       const LocalVector* positions, LocalVector* forces,
                       std::span<const std::byte> next) {
    add_forces(volume_modulus, groups, positions, forces, next);
}

void add_hybmss_forces(double volume_modulus, std::span<const CellGroup<float>> groups,
                       const LocalVector* positions, LocalVector* forces,
                       std::span<const std::byte> next) {
    add_forces(volume_modulus, groups, positions, forces, next);
}

}  // namespace incise::physics::INCISE_PROCESSOR
