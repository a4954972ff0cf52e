// Test for cells whose volume is zero to rounding.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// True if the volume of a cell is zero to rounding: the rounding of its coordinates alone can
/// cause a volume of this size.
/// @param volume  the signed volume of the cell
inline bool is_flat_to_rounding(CellKind kind, std::span<const Vec3> corners, double volume) {
    double largest = 0.0, longest = 0.0;
    for (const Vec3& x : corners) largest = std::max(largest, x.cwiseAbs().maxCoeff());
    const CellTraits& t = traits(kind);
    for (int k = 0; k < t.num_edges; ++k) {
        const auto [a, b] = t.edges[static_cast<std::size_t>(k)];
        longest = std::max(
            longest,
            (corners[static_cast<std::size_t>(b)] - corners[static_cast<std::size_t>(a)]).norm());
    }
    constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();
    return std::abs(volume) <= rounding * largest * longest * longest;
}

}  // namespace incise::topology
