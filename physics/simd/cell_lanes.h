// The volume term of HybMSS on lanes, shared by forces and energies. Compiled for each kind of
// processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "incise/physics/elements/hybmss_kernel.h"
#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

/// The BoxFrame of one cell in each lane, from corners relative to any origin.
template <class Number>
struct BoxLanes {
    using Scalar = Lanes<Number>;
    using Vector = Lanes3<Number>;
    using Corners = std::array<Vector, 8>;

    Vector a, b, c, across_a, across_b, across_c;

    [[gnu::always_inline]] inline explicit BoxLanes(const Corners& x) {
        const auto mean = [&](int a0, int a1, int b0, int b1, int c0, int c1, int d0, int d1) {
            const auto edge = [&](int from, int to) {
                return x[static_cast<std::size_t>(to)] - x[static_cast<std::size_t>(from)];
            };
            return Scalar(0.25) * (edge(a0, a1) + edge(b0, b1) + edge(c0, c1) + edge(d0, d1));
        };
        a = mean(0, 1, 3, 2, 4, 5, 7, 6), b = mean(0, 3, 1, 2, 4, 7, 5, 6);
        c = mean(0, 4, 1, 5, 2, 6, 3, 7);
        across_a = cross(b, c), across_b = cross(c, a), across_c = cross(a, b);
    }

    Scalar volume() const { return dot(a, across_a); }
    /// Returns the volume with the same bits as BoxFrame::volume().
    Scalar rounded_volume() const { return rounded_dot(a, rounded_cross(b, c)); }

    /// Adds the forces of the volume term, N. `ratio` is the volume over that at rest.
    [[gnu::always_inline]] inline void add_forces(double volume_modulus, Scalar ratio,
                                                  Corners& f) const {
        const Scalar quarter = -0.25 * volume_modulus * (ratio - 1.0);
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

}  // namespace incise::physics::INCISE_PROCESSOR
