// The squares of the principal stretches from the invariants of strain, and what sums over them
// have for derivatives by these: docs/theory.md, Laws. Templates over the kind of number as the
// laws are, without branches.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "incise/physics/laws/law_response.h"

namespace incise::physics {

// Of lanes: physics/simd/lanes.h.
inline double reciprocal_sqrt(double a) { return 1.0 / std::sqrt(a); }
/// cos(acos(x)/3) of |x| with the sign of x: the y furthest from zero with 4 y^3 - 3 y = x.
inline double cosine_of_third(double x) {
    return std::copysign(std::cos(std::acos(std::abs(x)) / 3.0), x);
}

/// The eigenvalues of the right Cauchy-Green tensor: a pair, and the one that is furthest from the
/// two others.
template <class T>
struct SquaredStretches {
    T apart, middle, half;       ///< the pair is middle + half and middle - half
    T distance, per_twice_half;  ///< of the one apart from the middle; 1/(2 half)
    T per_product;               ///< 1/(distance^2 - half^2)

    /// Eigenvalues that are so close that rounding hides how close are set apart, as far as it
    /// hides.
    /// @param s         the sign of J does not matter
    /// @param rounding  the relative error of the invariants: above zero
    /// @param floor     above zero; the error's scale where all eigenvalues are below it
    SquaredStretches(const LinkStrain<T>& s, double rounding, double floor) {
        using std::max, std::min;
        // 2E has the eigenvalues of C less 1; its deviator those of C less their mean m, which are
        // 2 r cos of an angle and of those a third of a turn from it. The deviator's determinant,
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
    /// The derivatives of a sum of h(c_k) over all three by the invariants, from the h'(c_k).
    ByInvariants derivatives(const std::array<T, 3>& slopes, const LinkStrain<T>& s) const {
        // h'(c) as mean + first (c - middle) + second ((c - middle)^2 - half^2).
        const T mean = 0.5 * (slopes[1] + slopes[2]),
                first = (slopes[1] - slopes[2]) * per_twice_half,
                second = (slopes[0] - mean - first * distance) * per_product;
        // The sum's derivative by C, that parabola with C for c, by
        // C^2 = I1 C - I2 1 + I3 C^-1; and da = tr dC, db = 2 tr((C - 1) dC),
        // dI3 = I3 tr(C^-1 dC).
        const T off = 1.0 - middle, I1_less_I2 = -s.a - 0.5 * (s.a * s.a - s.b);
        return {mean + first * off + second * (off * off - half * half - 1.0 + I1_less_I2),
                0.5 * (first + second * (3.0 + s.a - 2.0 * middle)), second};
    }
};

}  // namespace incise::physics
