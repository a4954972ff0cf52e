// Storage of results from lanes in ElementStates. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstring>

#include "incise/physics/elements/element_states.h"
#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

using DoubleLanes = Lanes<double>;
using DoubleLanes3 = Lanes3<double>;

/// Stores lanes at an address that needs only the alignment of a number.
inline void put(DoubleLanes values, double* to) { std::memcpy(to, &values.v, sizeof(values.v)); }

/// Stores the virials, J, of the part of a group that starts at lane `first`. `forces` are those on
/// all corners, and `edges` are the positions of these corners relative to one corner. This corner
/// itself may be left out.
template <std::size_t n>
[[gnu::always_inline]] inline void put_virials(const std::array<DoubleLanes3, n>& forces,
                                               const std::array<DoubleLanes3, n>& edges,
                                               ElementStates& states, std::size_t first) {
    const auto rows_of = [](const DoubleLanes3& v) { return std::array{v.x, v.y, v.z}; };
    std::array<DoubleLanes, 9> virial;
    virial.fill(0.0);
    for (std::size_t k = 0; k < n; ++k) {
        const auto f = rows_of(forces[k]), x = rows_of(edges[k]);
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j) virial[3 * i + j] += f[i] * x[j];
    }
    for (std::size_t i = 0; i < virial.size(); ++i) put(virial[i], states.virial[i] + first);
}

}  // namespace incise::physics::INCISE_PROCESSOR
