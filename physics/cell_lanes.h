// What forces and energies of HybMSS have in common: corners, and the volume term. Compiled for
// each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "physics/gather_lanes.h"
#include "physics/hybmss_kernel.h"
#include "physics/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

/// BoxFrame of as many cells as there are lanes, from their corners as seen from anywhere.
template <class Number>
struct BoxLanes {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    using Corners = std::array<Vector, 8>;

    Vector across_a, across_b, across_c;
    Scalar volume;

    [[gnu::always_inline]] inline explicit BoxLanes(const Corners& x) {
        const auto mean = [&](int a0, int a1, int b0, int b1, int c0, int c1, int d0, int d1) {
            const auto edge = [&](int from, int to) {
                return x[static_cast<std::size_t>(to)] - x[static_cast<std::size_t>(from)];
            };
            return Scalar(0.25) * (edge(a0, a1) + edge(b0, b1) + edge(c0, c1) + edge(d0, d1));
        };
        const Vector a = mean(0, 1, 3, 2, 4, 5, 7, 6), b = mean(0, 3, 1, 2, 4, 7, 5, 6),
                     c = mean(0, 4, 1, 5, 2, 6, 3, 7);
        across_a = cross(b, c), across_b = cross(c, a), across_c = cross(a, b);
        volume = dot(a, across_a);
    }

    /// Adds the forces of the volume term, N.
    [[gnu::always_inline]] inline void add_forces(double volume_modulus, Scalar rest_volume,
                                                  Corners& f) const {
        const Scalar quarter = -0.25 * volume_modulus * (volume / rest_volume - 1.0);
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
};

/// Corners of the part of a group that starts at lane `first`, as seen from corner 0.
template <class Number>
[[gnu::always_inline]] inline std::array<Lanes3<Number>, 8> gather_cells(
    const LocalVector* positions, const CellGroup<Number>& group, std::size_t first) {
    std::array<Lanes3<Number>, 8> x;
    x[0] = {0.0, 0.0, 0.0};
    const auto edges = gather_edges<Number>(positions, group.places, first);
    std::copy(edges.begin(), edges.end(), x.begin() + 1);
    return x;
}

}  // namespace incise::physics::INCISE_PROCESSOR
