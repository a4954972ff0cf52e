// The precision of forces by SIMD.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

namespace incise::physics {

/// The precision of the elastic forces in explicit steps; everything else is in doubles. Single
/// precision needs less time and memory. Its forces have errors of about 1e-6 of the stiffness of
/// an element times the area of its faces: docs/theory.md, Lanes.
enum class Precision : std::uint8_t { double_precision, single_precision };

}  // namespace incise::physics
