// Divided differences of powers of the squared stretches. With each point taken twice, they are the
// second derivatives, by the invariants, of a sum over eigenvalues.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

namespace incise::physics {

/// The derivative of the power c^p of a squared stretch c in Ogden's law. It is p c^(p - 1), and
/// below the floor the line p floor^(p - 2) c.
struct PowerSlope {
    double p, floor;
};

/// Returns the divided differences over c0, c1, c2 of c^m times the slope, for m = 0 to 2. The
/// accuracy and the conditions are those of doubled_differences().
std::array<double, 3> differences(const std::array<double, 3>& c, const PowerSlope& slope);

/// Returns the divided differences over c0, c0, c1, c1, c2, c2 of c^m times the slope, for m = 0 to
/// 4. They are accurate to rounding, also where points coincide, if all points are above the floor
/// or all are below.
///
/// The slope has a kink at the floor, and derivatives there are those of one side. A point below
/// the floor counts as above it if the next larger point does so and is within a hundredth of the
/// floor.
/// @pre c is ascending, with no value below zero
std::array<double, 5> doubled_differences(const std::array<double, 3>& c, const PowerSlope& slope);

}  // namespace incise::physics
