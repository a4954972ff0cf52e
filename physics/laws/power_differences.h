// Divided differences of powers of the squared stretches, each place taken twice: the second
// derivatives of a sum over eigenvalues by the invariants.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

namespace incise::physics {

/// The derivative of Ogden's power of a squared stretch c: p c^(p - 1), and below the floor a line
/// through zero, p floor^(p - 2) c.
struct PowerSlope {
    double p, floor;
};

/// Divided differences over c0, c1, c2 of c^m times the slope, for m = 0 to 2: see below.
std::array<double, 3> differences(const std::array<double, 3>& c, const PowerSlope& slope);

/// Divided differences over c0, c0, c1, c1, c2, c2 of c^m times the slope, for m = 0 to 4. To
/// rounding wherever the points lie, also where they coincide, if these are all above the floor or
/// all below; points on both sides of it but within a hundredth of it count as above: there the
/// slope has a kink, and its derivatives are those of one side.
/// @param c ascending, none below zero
std::array<double, 5> doubled_differences(const std::array<double, 3>& c, const PowerSlope& slope);

}  // namespace incise::physics
