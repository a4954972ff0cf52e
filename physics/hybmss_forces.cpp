// Compiled for each kind of processor: see lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/gather_lanes.h"
#include "physics/hybmss_kernel.h"

namespace incise::physics::INCISE_PROCESSOR {

namespace {

/// The part of a group that starts at lane `first`; as HybmssKernel::forces.
template <class Number>
[[gnu::always_inline]] inline void add_forces_of(double volume_modulus,
                                                 const CellGroup<Number>& group, std::size_t first,
                                                 const LocalVector* positions,
                                                 LocalVector* forces) {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    const auto load = [first](const auto& row) { return Scalar::load(row + first); };
    // Corners as seen from corner 0, whose force follows from the others'.
    std::array<Vector, 8> x, f;
    x.fill({0.0, 0.0, 0.0});
    f = x;
    const auto edges = gather_edges<Number>(positions, group.places, first);
    std::copy(edges.begin(), edges.end(), x.begin() + 1);
#pragma GCC unroll 7
    for (std::size_t g = 0; g < 7; ++g) {
        const Scalar k = load(group.stiffnesses[g]), at_rest = load(group.rest_pulls[g]);
#pragma GCC unroll 4
        for (const auto& [i, j] : HybmssKernel::springs[g]) {
            const Vector v = x[j] - x[i];
            // Finite, so that a spring without length, v = 0, does not push.
            const Scalar pull = k - at_rest * reciprocal_sqrt(dot(v, v));
            f[i] = f[i] + pull * v;
            f[j] = f[j] - pull * v;
        }
    }
    if (volume_modulus != 0.0) {
        const auto mean = [&](int a0, int a1, int b0, int b1, int c0, int c1, int d0, int d1) {
            const auto edge = [&](int from, int to) {
                return x[static_cast<std::size_t>(to)] - x[static_cast<std::size_t>(from)];
            };
            return Scalar(0.25) * (edge(a0, a1) + edge(b0, b1) + edge(c0, c1) + edge(d0, d1));
        };
        const Vector a = mean(0, 1, 3, 2, 4, 5, 7, 6), b = mean(0, 3, 1, 2, 4, 7, 5, 6),
                     c = mean(0, 4, 1, 5, 2, 6, 3, 7);
        const Vector across_a = cross(b, c), across_b = cross(c, a), across_c = cross(a, b);
        const Scalar volume = load(group.volume);
        const Scalar quarter = -0.25 * volume_modulus * (dot(a, across_a) / volume - 1.0);
        const Vector along_a = quarter * across_a, along_b = quarter * across_b,
                     along_c = quarter * across_c;
#pragma GCC unroll 8
        for (std::size_t k = 0; k < 8; ++k) {
            const auto& side = BoxFrame::sides[k];
            f[k] = side[0] > 0 ? f[k] + along_a : f[k] - along_a;
            f[k] = side[1] > 0 ? f[k] + along_b : f[k] - along_b;
            f[k] = side[2] > 0 ? f[k] + along_c : f[k] - along_c;
        }
    }
    std::array<Vector, 7> others;
    std::copy(f.begin() + 1, f.end(), others.begin());
    scatter_add<Number>(others, forces, group.places, first);
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
