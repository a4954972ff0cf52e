// Exact signs of determinants, with zeros decided by an infinitesimal shift of the tissue.
// Sources: [Shewchuk 1997] and [Edelsbrunner 1990] in docs/glossary.md. Internal to cutting: only
// .cpp files include this header, since it needs CGAL.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <CGAL/Mpzf.h>
#include <CGAL/determinant.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace incise::cutting {

/// A point in n dimensions. All tissue counts as shifted in space, at all times, by the same
/// infinitesimal (e, e^2, e^4). So each case is decided once, and alike from every element.
template <std::size_t n>
struct ShiftedPoint {
    std::array<double, n> x;  ///< the first three coordinates are space
    bool is_tissue = false;
};

/// The value of a determinant, and its sign after the shift.
struct ShiftedSign {
    int sign = 0;        ///< 0 only if no shift in space decides it
    double value = 0.0;  ///< without the shift; where near zero, the exact value rounded to double
};

namespace detail {

template <class Number, std::size_t n>
using Square = std::array<std::array<Number, n>, n>;

/// A number as the unevaluated sum of two, which has twice the digits of a double.
/// Source: [Shewchuk 1997].
struct Twofold {
    double high = 0.0, low = 0.0;
    Twofold() = default;
    explicit Twofold(double value) : high(value) {}
    Twofold(double high_part, double low_part) : high(high_part), low(low_part) {}
};

/// Returns the exact sum of two doubles.
inline Twofold exact_sum(double a, double b) {
    const double sum = a + b, part_of_b = sum - a;
    return {sum, (a - (sum - part_of_b)) + (b - part_of_b)};
}

/// Returns the exact product of two doubles, unless it overflows or underflows.
inline Twofold exact_product(double a, double b) {
    constexpr double split = 0x1.0p27 + 1.0;
    const double shifted_a = split * a, shifted_b = split * b;
    const double a_high = shifted_a - (shifted_a - a), b_high = shifted_b - (shifted_b - b);
    const double a_low = a - a_high, b_low = b - b_high, product = a * b;
    return {product,
            ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

/// Returns the sum, with an error of less than 2^-100 of the sum of the absolute values.
inline Twofold operator+(const Twofold& a, const Twofold& b) {
    const Twofold sum = exact_sum(a.high, b.high);
    const double rest = sum.low + (a.low + b.low), high = sum.high + rest;
    return {high, rest - (high - sum.high)};
}
inline Twofold operator-(const Twofold& a, const Twofold& b) {
    return a + Twofold{-b.high, -b.low};
}

/// Returns the product, with an error of less than 2^-100 of its absolute value.
inline Twofold operator*(const Twofold& a, const Twofold& b) {
    const Twofold product = exact_product(a.high, b.high);
    const double rest = product.low + (a.high * b.low + a.low * b.high), high = product.high + rest;
    return {high, rest - (high - product.high)};
}

/// Returns the matrix of the determinant, without the row of ones. That row is eliminated by
/// subtracting the last column. If `axis` is not negative, the row of this axis has 1 for tissue
/// and 0 for other points. The determinant is then the derivative with respect to the shift along
/// the axis.
template <class Number, std::size_t n>
Square<Number, n> reduced(const std::array<const ShiftedPoint<n>*, n + 1>& points, int axis) {
    const auto entry = [&](const ShiftedPoint<n>& point, std::size_t row) -> double {
        if (static_cast<int>(row) == axis) return point.is_tissue ? 1.0 : 0.0;
        return point.x[row];
    };
    Square<Number, n> m;
    for (std::size_t row = 0; row < n; ++row) {
        const Number last(entry(*points[n], row));
        for (std::size_t c = 0; c < n; ++c) m[row][c] = Number(entry(*points[c], row)) - last;
    }
    return m;
}

template <class Number>
Number determinant(const Square<Number, 3>& m) {
    return CGAL::determinant(m[0][0], m[0][1], m[0][2], m[1][0], m[1][1], m[1][2], m[2][0], m[2][1],
                             m[2][2]);
}

template <class Number>
Number determinant(const Square<Number, 4>& m) {
    return CGAL::determinant(m[0][0], m[0][1], m[0][2], m[0][3], m[1][0], m[1][1], m[1][2], m[1][3],
                             m[2][0], m[2][1], m[2][2], m[2][3], m[3][0], m[3][1], m[3][2],
                             m[3][3]);
}

/// Returns the sum of the absolute values of all products of a determinant. Rounding errors are in
/// proportion to it.
inline double permanent(const Square<double, 3>& m) {
    const auto at = [&](std::size_t r, std::size_t c) { return std::abs(m[r][c]); };
    double sum = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t d = (c + 1) % 3, e = (c + 2) % 3;
        sum += at(0, c) * (at(1, d) * at(2, e) + at(1, e) * at(2, d));
    }
    return sum;
}

inline double permanent(const Square<double, 4>& m) {
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

/// Returns the sign from floating point, or nothing if rounding errors might change it.
template <std::size_t n>
std::optional<ShiftedSign> rounded_sign(const std::array<const ShiftedPoint<n>*, n + 1>& points,
                                        int axis) {
    const auto m = reduced<double, n>(points, axis);
    const double value = determinant(m);
    // Each of the at most 24 products has four rounded differences and fewer than twelve other
    // roundings. So 64 units of rounding are a generous bound of their sum.
    constexpr double bound = 64.0 * 0x1.0p-53;
    const double uncertainty = bound * permanent(m);
    if (std::abs(value) > uncertainty && uncertainty > 0x1.0p-900)
        return ShiftedSign{value > 0.0 ? 1 : -1, value};
    return std::nullopt;
}

/// Returns the sign as rounded_sign() does, from twice the digits.
template <std::size_t n>
std::optional<int> twofold_sign(const std::array<const ShiftedPoint<n>*, n + 1>& points, int axis) {
    const auto m = reduced<double, n>(points, axis);
    // Differences are exact, as is what products lose unless they underflow. With entries that are
    // not huge, underflows stay below the least uncertainty.
    for (const auto& row : m)
        for (const double entry : row)
            if (!(std::abs(entry) < 0x1.0p40)) return std::nullopt;
    constexpr double bound = 64.0 * 0x1.0p-100;
    const double uncertainty = bound * permanent(m);
    const double value = determinant(reduced<Twofold, n>(points, axis)).high;
    if (std::abs(value) > uncertainty && uncertainty > 0x1.0p-900) return value > 0.0 ? 1 : -1;
    return std::nullopt;
}

template <std::size_t n>
ShiftedSign exact_sign(const std::array<const ShiftedPoint<n>*, n + 1>& points, int axis) {
    const CGAL::Mpzf exact = determinant(reduced<CGAL::Mpzf, n>(points, axis));
    return {static_cast<int>(CGAL::sign(exact)), CGAL::to_double(exact)};
}

}  // namespace detail

/// Returns the orientation of n + 1 points in n dimensions (3, or 4 with time as the last). Returns
/// nothing if this needs more digits, which takes ten to a hundred times as long.
template <std::size_t n>
std::optional<ShiftedSign> clear_orientation(
    const std::array<const ShiftedPoint<n>*, n + 1>& points) {
    return detail::rounded_sign<n>(points, -1);
}

/// Returns the sign of the orientation of n + 1 points, by exact arithmetic where necessary.
template <std::size_t n>
int orientation_sign(const std::array<const ShiftedPoint<n>*, n + 1>& points) {
    const auto sign = [&](int axis) {
        if (const auto rounded = detail::rounded_sign<n>(points, axis)) return rounded->sign;
        if (const auto finer = detail::twofold_sign<n>(points, axis)) return *finer;
        return detail::exact_sign<n>(points, axis).sign;
    };
    int result = sign(-1);
    for (int axis = 0; axis < 3 && result == 0; ++axis) result = sign(axis);
    return result;
}

/// Returns the value of the orientation of n + 1 points, without the shift. Where near zero, it is
/// the exact value rounded to double.
template <std::size_t n>
double orientation_value(const std::array<const ShiftedPoint<n>*, n + 1>& points) {
    const auto rounded = detail::rounded_sign<n>(points, -1);
    return rounded ? rounded->value : detail::exact_sign<n>(points, -1).value;
}

}  // namespace incise::cutting
