// The squares of the principal stretches from the invariants of strain, and the derivatives of sums
// over the squares by the invariants: docs/theory.md, Laws. Like the laws, these are templates over
// the type of number, without branches.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "incise/physics/laws/law_response.h"

namespace incise::physics {

// physics/simd/lanes.h has both functions for lanes.
inline double reciprocal_sqrt(double a) { return 1.0 / std::sqrt(a); }
/// Returns cos(acos(|x|)/3) with the sign of x: the root of 4 y^3 - 3 y = x furthest from zero.
inline double cosine_of_third(double x) {
    return std::copysign(std::cos(std::acos(std::abs(x)) / 3.0), x);
}

/// The eigenvalues of the right Cauchy-Green tensor C: the one that is furthest from the two
/// others, and these two as a pair.
template <class T>
struct SquaredStretches {
    T apart, middle, half;       ///< the pair is middle + half and middle - half
    T distance, per_twice_half;  ///< apart - middle; 1/(2 half)
    T per_product;               ///< 1/(distance^2 - half^2)

    /// Computes the eigenvalues. Eigenvalues closer than rounding can resolve are set apart by the
    /// smallest distance that it can resolve.
    /// @param s         the strain; the sign of J has no effect
    /// @param rounding  the relative error of the invariants, above zero
    /// @param floor     above zero; scale of the error where all eigenvalues are below it
    SquaredStretches(const LinkStrain<T>& s, double rounding, double floor) {
        using std::max, std::min;
        // The deviator of 2E has the eigenvalues of C less their mean m. These are 2 r cos(angle),
        // and the same at a third of a turn to either side. The determinant of the deviator,
        // 2 r^3 cos(3 angle), follows from det C = J^2.
        const T m = 1.0 + s.a * (1.0 / 3.0);
        const T square = max(T(s.b * (1.0 / 6.0) - s.a * s.a * (1.0 / 18.0)), T(0.0));
        const T size = max(m, T(floor)), least = rounding * size * size;
        const T r_square = max(square, least);
        const T per_r = reciprocal_sqrt(r_square), r = r_square * per_r;
        const T det = s.J * s.J - m * (m * m - 3.0 * square);
        const T per_cube = 0.5 * per_r * per_r * per_r;
        const T limit = max(T(1.0 - 0.5 * least * size * per_cube), T(0.5));
        const T y = cosine_of_third(max(min(T(det * per_cube), limit), T(-limit)));
        const T half_square = max(T(3.0 * r_square * (1.0 - y * y)), T(least * (1.0 / 16.0)));
        const T per_half = reciprocal_sqrt(half_square);
        apart = m + 2.0 * r * y;
        middle = m - r * y;
        half = half_square * per_half;
        distance = 3.0 * r * y;
        per_twice_half = 0.5 * per_half;
        per_product = 1.0 / (distance * distance - half_square);
    }

    std::array<T, 3> all() const { return {apart, middle + half, middle - half}; }

    struct ByInvariants {
        T a, b, I3;
    };
    /// Returns the derivatives by the invariants of the sum of h(c_k) over all three eigenvalues.
    /// `slopes` has h'(c_k) in the order of all().
    ByInvariants derivatives(const std::array<T, 3>& slopes, const LinkStrain<T>& s) const {
        // The parabola through the three h'(c) is
        // mean + first (c - middle) + second ((c - middle)^2 - half^2).
        const T mean = 0.5 * (slopes[1] + slopes[2]),
                first = (slopes[1] - slopes[2]) * per_twice_half,
                second = (slopes[0] - mean - first * distance) * per_product;
        // The derivative of the sum by C is this parabola with C for c. It follows with
        // C^2 = I1 C - I2 1 + I3 C^-1, da = tr dC, db = 2 tr((C - 1) dC), dI3 = I3 tr(C^-1 dC).
        const T off = 1.0 - middle, I1_less_I2 = -s.a - 0.5 * (s.a * s.a - s.b);
        return {mean + first * off + second * (off * off - half * half - 1.0 + I1_less_I2),
                0.5 * (first + second * (3.0 + s.a - 2.0 * middle)), second};
    }
};

}  // namespace incise::physics
