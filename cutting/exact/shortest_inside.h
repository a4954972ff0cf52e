// The shortest way into a corner between planes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/base/types.h"

namespace incise::cutting {

/// The points x with normal . x <= -depth.
struct InnerSide {
    Vec3 normal;   ///< of unit length
    double depth;  ///< m
};

/// Returns the shortest vector that is on all inner sides; zero if there is none up to a length.
/// @param most  that length, m
/// Cost: O(n^4) for n sides; meant for up to six.
Vec3 shortest_inside(std::span<const InnerSide> sides, double most);

}  // namespace incise::cutting
