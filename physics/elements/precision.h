// What kind of numbers the fast forces are computed in.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

namespace incise::physics {

/// That of the explicit elastic forces of an element; all else is in doubles. Single takes less
/// time and memory; its forces are good to some 1e-6 of an element's stiffness times the
/// area of its sides: docs/theory.md, Lanes.
enum class Precision : std::uint8_t { double_precision, single_precision };

}  // namespace incise::physics
