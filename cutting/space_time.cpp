// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/space_time.h"

#include <CGAL/MP_Float.h>
#include <CGAL/determinant.h>

#include <cmath>

namespace incise::cutting {

namespace {

/// A point in space and time; time is 0 before the step and 1 after it.
struct Event {
    Vec3 x;
    double time;
    bool is_tissue;
};

using Five = std::array<const Event*, 5>;

/// Rows of the determinant: x, y, z, one of which may be replaced by the indicator of tissue
/// (the derivative with respect to the shift along that axis); then time. The row of ones is
/// eliminated by subtracting the last column.
template <class Number>
std::array<std::array<Number, 4>, 4> reduced(const Five& events, int shifted_axis) {
    const auto entry = [&](const Event& event, int row) -> double {
        if (row == 3) return event.time;
        if (row == shifted_axis) return event.is_tissue ? 1.0 : 0.0;
        return event.x[row];
    };
    std::array<std::array<Number, 4>, 4> m;
    for (int row = 0; row < 4; ++row) {
        const Number last(entry(*events[4], row));
        for (std::size_t c = 0; c < 4; ++c)
            m[static_cast<std::size_t>(row)][c] = Number(entry(*events[c], row)) - last;
    }
    return m;
}

template <class Number>
Number determinant(const std::array<std::array<Number, 4>, 4>& m) {
    return CGAL::determinant(m[0][0], m[0][1], m[0][2], m[0][3], m[1][0], m[1][1], m[1][2], m[1][3],
                             m[2][0], m[2][1], m[2][2], m[2][3], m[3][0], m[3][1], m[3][2],
                             m[3][3]);
}

/// The determinant with all signs positive: what its rounding errors are measured by.
double permanent(const std::array<std::array<double, 4>, 4>& m) {
    const auto at = [&](std::size_t r, std::size_t c) { return std::abs(m[r][c]); };
    double sum = 0.0;
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t b = 0; b < 4; ++b) {
            if (b == a) continue;
            // The two columns that remain.
            std::size_t rest[2], k = 0;
            for (std::size_t c = 0; c < 4; ++c)
                if (c != a && c != b) rest[k++] = c;
            sum += at(0, a) * at(1, b) *
                   (at(2, rest[0]) * at(3, rest[1]) + at(2, rest[1]) * at(3, rest[0]));
        }
    return sum;
}

int sign_of_determinant(const Five& events, int shifted_axis) {
    const auto m = reduced<double>(events, shifted_axis);
    const double value = determinant(m);
    // Each of the 24 products has four rounded differences and under a dozen roundings more:
    // 64 units of rounding bound their sum generously.
    constexpr double bound = 64.0 * 0x1.0p-53;
    const double uncertainty = bound * permanent(m);
    if (std::abs(value) > uncertainty && uncertainty > 0x1.0p-900) return value > 0.0 ? 1 : -1;
    const CGAL::MP_Float exact = determinant(reduced<CGAL::MP_Float>(events, shifted_axis));
    return static_cast<int>(CGAL::sign(exact));
}

/// Orientation of five events with the tissue shifted infinitesimally; 0 only if no shift in
/// space decides it.
int orientation(const Five& events) {
    for (const int axis : {-1, 0, 1, 2})
        if (const int sign = sign_of_determinant(events, axis); sign != 0) return sign;
    return 0;
}

/// Six events span one more point than four dimensions have, so some combination of them
/// vanishes: its coefficients are the minors with alternating signs. The triangles meet if those
/// of the first are all of one sign and those of the second all of the other.
bool triangles_meet(const std::array<const Event*, 3>& s, const std::array<const Event*, 3>& t) {
    const std::array<const Event*, 6> events = {s[0], s[1], s[2], t[0], t[1], t[2]};
    int first = 0;
    for (std::size_t k = 0; k < 6; ++k) {
        Five others{};
        for (std::size_t i = 0, n = 0; i < 6; ++i)
            if (i != k) others[n++] = events[i];
        int sign = orientation(others);
        if (k % 2 == 1) sign = -sign;
        if (k >= 3) sign = -sign;
        if (sign == 0) return false;
        if (k == 0)
            first = sign;
        else if (sign != first)
            return false;
    }
    return true;
}

}  // namespace

bool cross(const MovingSegment& tissue, const MovingSegment& blade) {
    const auto events = [](const MovingSegment& s, bool is_tissue) {
        return std::array<Event, 4>{{{s.a[0], 0.0, is_tissue},
                                     {s.b[0], 0.0, is_tissue},
                                     {s.b[1], 1.0, is_tissue},
                                     {s.a[1], 1.0, is_tissue}}};
    };
    const auto p = events(tissue, true), q = events(blade, false);
    bool is_odd = false;
    // Both triangles of a surface contain its diagonal from (a, before) to (b, after).
    for (const std::size_t i : {1u, 2u})
        for (const std::size_t j : {1u, 2u})
            is_odd ^= triangles_meet({&p[0], &p[i], &p[i + 1]}, {&q[0], &q[j], &q[j + 1]});
    return is_odd;
}

}  // namespace incise::cutting
