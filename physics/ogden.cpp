// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/ogden.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace incise::physics {

namespace {

/// A function of a squared stretch, with its first derivatives.
struct Power {
    double value, first, second, third;
};

/// c^(alpha/2); below the floor a parabola goes on whose slope falls to zero at c = 0. Negative
/// powers would be a wall that keeps inverted elements inverted.
Power power(double c, double alpha, double floor) {
    const double p = 0.5 * alpha, at = std::max(c, floor);
    const double value = std::pow(at, p);
    Power f{value, p * value / at, p * (p - 1.0) * value / (at * at),
            p * (p - 1.0) * (p - 2.0) * value / (at * at * at)};
    if (c < floor) {
        const double d = c - floor;
        f.second = f.first / floor;
        f.third = 0.0;
        f.value += d * (f.first + 0.5 * d * f.second);
        f.first += d * f.second;
    }
    return f;
}

/// Divided differences of the derivative of `power` at three places: what interpolates it there by
/// a parabola in Newton's form. Of places that are close together differences would lose their
/// digits: their means are taken instead, by Gauss's rule.
struct Differences {
    double at_first, first, second;
};

Differences differences(const std::array<double, 3>& c, double alpha, double floor) {
    constexpr double close = 0.05;  // relative; five Gauss points are exact to rounding there
    const auto slope = [&](double x) { return power(x, alpha, floor).first; };
    const auto mean_of_second = [&](double a, double b) {
        if (std::abs(b - a) > close * std::max(b, floor)) return (slope(b) - slope(a)) / (b - a);
        constexpr std::array<double, 3> x = {0.0, 0.5384693101056831, 0.9061798459386640};
        constexpr std::array<double, 3> w = {0.5688888888888889, 0.4786286704993665,
                                             0.2369268850561891};
        const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
        double sum = w[0] * power(middle, alpha, floor).second;
        for (std::size_t i = 1; i < 3; ++i)
            sum += w[i] * (power(middle + half * x[i], alpha, floor).second +
                           power(middle - half * x[i], alpha, floor).second);
        return 0.5 * sum;
    };
    Differences d{slope(c[0]), mean_of_second(c[0], c[1]), 0.0};
    const double width = c[2] - c[0];
    if (width > close * std::max(c[2], floor)) {
        d.second = (mean_of_second(c[1], c[2]) - d.first) / width;
        return d;
    }
    // f'[c0, c1, c2] is the integral of t f''' over the triangle of weights: from the differences
    // of f'' along it.
    constexpr std::array<double, 5> t = {0.04691007703066802, 0.2307653449471585, 0.5,
                                         0.7692346550528415, 0.9530899229693320};
    constexpr std::array<double, 5> w = {0.1184634425280945, 0.2393143352496832, 0.2844444444444444,
                                         0.2393143352496832, 0.1184634425280945};
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j) {
            const double u = t[i], v = t[i] * t[j];
            const double x = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[1]);
            d.second += w[i] * w[j] * u * power(x, alpha, floor).third;
        }
    return d;
}

}  // namespace

std::array<double, 3> squared_principal_stretches(const LinkStrain& s) {
    // 2E has the eigenvalues of C less 1; its deviator those of C less their mean.
    const double mean = s.a / 3.0;
    const double square = std::max(s.b - s.a * mean, 0.0);  // of the deviator
    const double radius = std::sqrt(square / 6.0);
    std::array<double, 3> c;
    c.fill(std::max(1.0 + mean, 0.0));
    if (!(radius > 0.0)) return c;
    // det C = J^2 = (1 + mean)^3 - (1 + mean) square / 2 + det(deviator)
    const double m = 1.0 + mean;
    const double det = s.J * s.J - m * m * m + 0.5 * m * square;
    const double cosine = std::clamp(0.5 * det / (radius * radius * radius), -1.0, 1.0);
    const double angle = std::acos(cosine) / 3.0;
    for (int k = 0; k < 3; ++k)
        c[static_cast<std::size_t>(k)] = std::max(
            m + 2.0 * radius * std::cos(angle - 2.0 * std::numbers::pi / 3.0 * (k + 1)), 0.0);
    std::sort(c.begin(), c.end());
    return c;
}

// With c_k the squared stretches, h(c) = c^(alpha/2) and the derivative h' interpolated at the c_k
// by q0 + q1 c + q2 c^2: dh = tr((q0 1 + q1 C + q2 C^2) dC), and by Cayley and Hamilton
// C^2 = I1 C - I2 1 + J^2 C^-1. The derivatives by a, b and J follow from da = tr dC,
// db = 2 tr((C - 1) dC), dJ = J/2 tr(C^-1 dC).
LawResponse Ogden::response(const LinkStrain& s, double J0) const {
    const auto c = squared_principal_stretches(s);
    const double floor = J0 * J0;
    const double I1 = 3.0 + s.a, I2 = 3.0 + 2.0 * s.a + 0.5 * (s.a * s.a - s.b);
    const VolumeTerm v = quadratic_volume_term(s.J, bulk_modulus);
    LawResponse r{v.value, 0.0, 0.0, v.first};
    for (std::size_t i = 0; i < num_terms; ++i) {
        const auto [mu, alpha] = terms[i];
        const double factor = 2.0 * mu / (alpha * alpha);
        const VolumeTerm g =
            extended([&](double J) { return power_of_volume(J, alpha / 3.0); }, s.J, J0);
        double sum = 0.0;
        for (const double x : c) sum += power(x, alpha, floor).value;
        const Differences d = differences(c, alpha, floor);
        const double q2 = d.second, q1 = d.first - q2 * (c[0] + c[1]),
                     q0 = d.at_first - d.first * c[0] + q2 * c[0] * c[1];
        const double of_one = q0 - q2 * I2, of_C = q1 + q2 * I1;
        r.w += factor * (g.value * sum - 3.0);
        r.w_a += factor * g.value * (of_one + of_C);
        r.w_b += factor * g.value * 0.5 * of_C;
        r.w_J += factor * (g.first * sum + g.value * 2.0 * q2 * s.J);
    }
    return r;
}

}  // namespace incise::physics
