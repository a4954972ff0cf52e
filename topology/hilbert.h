// Position along a Hilbert curve: points near each other mostly get numbers near each other.
// Source: J. Skilling, Programming the Hilbert curve, AIP Conference Proceedings 707 (2004).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// The order in which a Hilbert curve through the bounding box visits the points; equal places
/// keep their order. Cost: O(n log n).
std::vector<std::size_t> hilbert_order(std::span<const Vec3> points);

}  // namespace incise::topology
