// From lanes to ElementStates. Compiled for each kind of processor: lanes.h.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstring>

#include "incise/physics/elements/element_states.h"
#include "incise/physics/simd/lanes.h"

namespace incise::physics::INCISE_PROCESSOR {

using DoubleLanes = Lanes<double>;
using DoubleLanes3 = Lanes3<double>;

/// Wherever that lies: vectors are aligned to a number only.
inline void put(DoubleLanes values, double* to) { std::memcpy(to, &values.v, sizeof(values.v)); }

/// Those of the part of a group that starts at lane `first`, from the forces on all corners but
/// one, and where they are as seen from that.
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
