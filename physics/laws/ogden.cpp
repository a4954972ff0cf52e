// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/ogden.h"

#include <algorithm>

#include "incise/physics/laws/power_differences.h"

namespace incise::physics {

namespace {

/// Returns the squared stretches, accurate also where they coincide.
std::array<double, 3> squared_stretches(const LinkStrain<double>& s, double floor) {
    return SquaredStretches<double>(s, 1e-100, floor).all();
}

}  // namespace

LawResponse<double> Ogden::response(const LinkStrain<double>& s, double J0) const {
    LawResponse<double> r = response<double>(s, J0);
    r.w = energy_density(s, J0);
    return r;
}

// P is the sum of h(c_k) as a function of I1, I2 and I3 = J^2. The characteristic polynomial p(c)
// gives dc = (c^2 dI1 - c dI2 + dI3) / p'(c). With e = (c^2, -c, 1), the first derivatives of P are
// the divided differences of e_i h' over c0, c1, c2. The second derivatives are those of e_i e_j h'
// over the same points, each taken twice.
LawResponse<Dual> Ogden::response(const LinkStrain<Dual>& strain, double J0) const {
    const LinkStrain<double> s{strain.a.value, strain.b.value, strain.J.value};
    const double floor = J0 * J0;
    auto c = squared_stretches(s, floor);
    const PowersOfStretches<double> powers(c, floor, 0.0);
    for (double& x : c) x = std::max(x, 0.0);
    std::sort(c.begin(), c.end());
    const double J = s.J, I2_a = 2.0 + s.a;  // dI2/da; dI2/db = -1/2, d2I2/da2 = 1
    const auto v = quadratic_volume_term(J, bulk_modulus);
    Eigen::Vector3d w_p(0.0, 0.0, v.first);          // derivatives by a, b and J
    Eigen::Matrix3d w_pq = Eigen::Matrix3d::Zero();  // second derivatives
    w_pq(2, 2) = v.second;
    for (std::size_t i = 0; i < num_terms; ++i) {
        const auto [mu, alpha] = terms[i];
        const double factor = 2.0 * mu / (alpha * alpha), p = 0.5 * alpha;
        const auto g = isochoric_factor(J, alpha, J0);
        std::array<double, 3> unused{};
        const double sum = powers.add(p, 1.0, unused);
        const auto S = differences(c, {p, floor});
        const double P_1 = S[2], P_2 = -S[1], P_3 = S[0], P_a = P_1 + I2_a * P_2, P_b = -0.5 * P_2;
        const auto D = doubled_differences(c, {p, floor});
        const double P_11 = D[4], P_12 = -D[3], P_13 = D[2], P_22 = D[2], P_23 = -D[1], P_33 = D[0];
        w_p[0] += factor * g.value * P_a;
        w_p[1] += factor * g.value * P_b;
        w_p[2] += factor * (g.first * sum + g.value * 2.0 * J * P_3);
        w_pq(0, 0) += factor * g.value * (P_11 + I2_a * (2.0 * P_12 + I2_a * P_22) + P_2);
        w_pq(0, 1) -= factor * g.value * 0.5 * (P_12 + I2_a * P_22);
        w_pq(1, 1) += factor * g.value * 0.25 * P_22;
        w_pq(0, 2) += factor * (g.first * P_a + g.value * 2.0 * J * (P_13 + I2_a * P_23));
        w_pq(1, 2) += factor * (g.first * P_b - g.value * J * P_23);
        w_pq(2, 2) += factor * (g.second * sum + g.first * 4.0 * J * P_3 +
                                g.value * (2.0 * P_3 + 4.0 * J * J * P_33));
    }
    w_pq(1, 0) = w_pq(0, 1);
    w_pq(2, 0) = w_pq(0, 2);
    w_pq(2, 1) = w_pq(1, 2);
    const auto along = [&](const Eigen::Vector3d& by) -> Eigen::Vector4d {
        return by[0] * strain.a.gradient + by[1] * strain.b.gradient + by[2] * strain.J.gradient;
    };
    return {{energy_density(s, J0), along(w_p)},
            {w_p[0], along(w_pq.col(0))},
            {w_p[1], along(w_pq.col(1))},
            {w_p[2], along(w_pq.col(2))}};
}

}  // namespace incise::physics
