// Order along a Hilbert curve, in which points that are near each other mostly follow each other.
// Source: J. Skilling, Programming the Hilbert curve, AIP Conference Proceedings 707 (2004).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// Returns the indices of the points in the order in which a Hilbert curve through their bounding
/// box visits them. Points in the same cell of the curve keep their order. Cost: O(n log n).
std::vector<std::size_t> hilbert_order(std::span<const Vec3> points);

}  // namespace incise::topology
