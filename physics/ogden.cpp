// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/ogden.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/power_differences.h"

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

/// J^(-alpha/3).
VolumeTerm<double> isochoric_factor(double J, double alpha, double J0) {
    return extended([=](double x) { return power_of_volume(x, alpha / 3.0); }, J, J0);
}

/// The sum of h(c_k) = c_k^(alpha/2), and its derivative by C as (of_one) 1 + (of_C) C + q2 J^2
/// C^-1.
///
/// With the derivative h' interpolated at the c_k by q0 + q1 c + q2 c^2 it is q0 1 + q1 C + q2 C^2,
/// and by Cayley and Hamilton C^2 = I1 C - I2 1 + J^2 C^-1.
struct PowerSum {
    double value = 0.0, of_one, of_C, q2;

    PowerSum(const std::array<double, 3>& c, const LinkStrain<double>& s, double alpha,
             double floor) {
        const double I1 = 3.0 + s.a, I2 = 3.0 + 2.0 * s.a + 0.5 * (s.a * s.a - s.b);
        for (const double x : c) value += power(x, alpha, floor).value;
        const Differences d = differences(c, alpha, floor);
        q2 = d.second;
        const double q1 = d.first - q2 * (c[0] + c[1]),
                     q0 = d.at_first - d.first * c[0] + q2 * c[0] * c[1];
        of_one = q0 - q2 * I2;
        of_C = q1 + q2 * I1;
    }
};

}  // namespace

std::array<double, 3> squared_principal_stretches(const LinkStrain<double>& s) {
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

// The derivatives by a, b and J follow from da = tr dC, db = 2 tr((C - 1) dC),
// dJ = J/2 tr(C^-1 dC).
LawResponse<double> Ogden::response(const LinkStrain<double>& s, double J0) const {
    const auto c = squared_principal_stretches(s);
    const auto v = quadratic_volume_term(s.J, bulk_modulus);
    LawResponse<double> r{v.value, 0.0, 0.0, v.first};
    for (std::size_t i = 0; i < num_terms; ++i) {
        const auto [mu, alpha] = terms[i];
        const double factor = 2.0 * mu / (alpha * alpha);
        const auto g = isochoric_factor(s.J, alpha, J0);
        const PowerSum sum(c, s, alpha, J0 * J0);
        r.w += factor * (g.value * sum.value - 3.0);
        r.w_a += factor * g.value * (sum.of_one + sum.of_C);
        r.w_b += factor * g.value * 0.5 * sum.of_C;
        r.w_J += factor * (g.first * sum.value + g.value * 2.0 * sum.q2 * s.J);
    }
    return r;
}

// The sum P of h(c_k) as a function of I1, I2 and I3 = J^2: by the characteristic polynomial p(c),
// dc = (c^2 dI1 - c dI2 + dI3) / p'(c). With e = (c^2, -c, 1) the first derivatives of P are the
// divided differences of e_i h' over c0, c1, c2, and the second ones those of e_i e_j h' over the
// same places, each taken twice.
LawResponse<Dual> Ogden::response(const LinkStrain<Dual>& strain, double J0) const {
    const LinkStrain<double> s{strain.a.value, strain.b.value, strain.J.value};
    const LawResponse<double> r = response(s, J0);
    const auto c = squared_principal_stretches(s);
    const double J = s.J, I2_a = 2.0 + s.a;       // and I2_b = -1/2, I2_aa = 1
    Eigen::Matrix3d w = Eigen::Matrix3d::Zero();  // second derivatives by a, b and J
    w(2, 2) = bulk_modulus;
    for (std::size_t i = 0; i < num_terms; ++i) {
        const auto [mu, alpha] = terms[i];
        const double factor = 2.0 * mu / (alpha * alpha);
        const auto g = isochoric_factor(J, alpha, J0);
        const PowerSum sum(c, s, alpha, J0 * J0);
        const double P_a = sum.of_one + sum.of_C, P_b = 0.5 * sum.of_C, P_2 = -sum.of_C,
                     P_3 = sum.q2;
        const auto D = doubled_differences(c, {0.5 * alpha, J0 * J0});
        const double P_11 = D[4], P_12 = -D[3], P_13 = D[2], P_22 = D[2], P_23 = -D[1], P_33 = D[0];
        w(0, 0) += factor * g.value * (P_11 + I2_a * (2.0 * P_12 + I2_a * P_22) + P_2);
        w(0, 1) -= factor * g.value * 0.5 * (P_12 + I2_a * P_22);
        w(1, 1) += factor * g.value * 0.25 * P_22;
        w(0, 2) += factor * (g.first * P_a + g.value * 2.0 * J * (P_13 + I2_a * P_23));
        w(1, 2) += factor * (g.first * P_b - g.value * J * P_23);
        w(2, 2) += factor * (g.second * sum.value + g.first * 4.0 * J * P_3 +
                             g.value * (2.0 * P_3 + 4.0 * J * J * P_33));
    }
    w(1, 0) = w(0, 1);
    w(2, 0) = w(0, 2);
    w(2, 1) = w(1, 2);
    const auto along = [&](const Eigen::Vector3d& by) -> Eigen::Vector4d {
        return by[0] * strain.a.gradient + by[1] * strain.b.gradient + by[2] * strain.J.gradient;
    };
    return {{r.w, along({r.w_a, r.w_b, r.w_J})},
            {r.w_a, along(w.col(0))},
            {r.w_b, along(w.col(1))},
            {r.w_J, along(w.col(2))}};
}

}  // namespace incise::physics
