// Ogden's law: sums of powers of the principal stretches, which are computed from the invariants of
// strain. Equations: docs/theory.md, Laws.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <limits>

#include "incise/physics/laws/law_response.h"
#include "incise/physics/laws/squared_stretches.h"

namespace incise::physics {

/// w = sum_i 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + K/2 (J - 1)^2, with
/// l_k = J^-1/3 times the principal stretches. The shear modulus at rest is the sum of the mu_i.
/// Powers of squared stretches below J0^2 continue as a parabola with slope zero at zero stretch.
/// Flat elements then have finite forces, and inverted elements recover.
struct Ogden {
    static constexpr std::size_t max_terms = 6;
    struct Term {
        double mu, alpha;  ///< Pa, 1; mu alpha may be negative in a term, but not in the sum
    };
    std::array<Term, max_terms> terms{};
    std::size_t num_terms = 0;
    double bulk_modulus = 0.0;  ///< Pa

    double rest_mu() const {
        double sum = 0.0;
        for (std::size_t i = 0; i < num_terms; ++i) sum += terms[i].mu;
        return sum;
    }
    double rest_lambda() const { return bulk_modulus - 2.0 / 3.0 * rest_mu(); }
    /// Returns the response for forces. Stresses, which combine all derivatives, are accurate to
    /// rounding. A single derivative is less accurate where stretches nearly coincide.
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const;
    /// Returns the same response, but with an energy that is zero at rest.
    LawResponse<double> response(const LinkStrain<double>& s, double J0) const;
    /// Returns this energy alone. The fast forces do not need it.
    template <class T>
    T energy_density(const LinkStrain<T>& s, double J0) const;
    /// Returns a response with each derivative accurate by itself, as tangents require.
    LawResponse<Dual> response(const LinkStrain<Dual>& s, double J0) const;
};

/// Powers h(c_k) = c_k^p of the three squared stretches, in a given unit. Below the floor h
/// continues as a parabola with slope zero at c = 0. Without it, a negative power would be an
/// infinite barrier that keeps inverted elements inverted.
template <class T>
struct PowersOfStretches {
    std::array<T, 3> logs;      ///< ln of max(c, floor) over the unit
    std::array<T, 3> relative;  ///< h'(c)/(p h(max(c, floor))): 1/c, below the floor c/floor^2
    std::array<T, 3> below;     ///< (h/h(floor) - 1)/p below the floor, else 0

    PowersOfStretches(const std::array<T, 3>& c, double floor, const T& log_of_unit) {
        using std::log, std::max, std::min;
        for (std::size_t k = 0; k < 3; ++k) {
            const T at = max(c[k], T(floor)), under = min(c[k], T(floor));
            logs[k] = log(at) - log_of_unit;
            relative[k] = under / (floor * at);
            const T d = T(under - floor) * (1.0 / floor);
            below[k] = d * (1.0 + 0.5 * d);
        }
    }

    /// Returns the sum of h(c_k). Adds factor * h'(c_k) / relative[k] to slopes[k].
    T add(double p, const T& factor, std::array<T, 3>& slopes) const {
        using std::exp;
        const T slope = p * factor;
        T sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const T power = exp(T(p * logs[k]));
            slopes[k] += slope * power;
            sum += power * (1.0 + p * below[k]);
        }
        return sum;
    }
};

/// J^(-alpha/3), extended below J0.
template <class T>
VolumeTerm<T> isochoric_factor(const T& J, double alpha, double J0) {
    return extended([=](const T& x) { return power_of_volume(x, alpha / 3.0); }, J, J0);
}

template <class T>
LawResponse<T> Ogden::response(const LinkStrain<T>& s, double J0) const {
    using std::log, std::max, std::min;
    const double floor = J0 * J0;
    const T J = max(s.J, T(J0)), per_J = 1.0 / J, log_of_unit = 2.0 / 3.0 * log(J);
    const SquaredStretches<T> stretches(s, double{std::numeric_limits<T>::epsilon()}, floor);
    const PowersOfStretches<T> powers(stretches.all(), floor, log_of_unit);
    const T d = min(T(s.J - J0), T(0.0)) * (1.0 / J0);
    const VolumeTerm<T> v = quadratic_volume_term(s.J, bulk_modulus);
    T w = v.value, w_J = v.first;
    std::array<T, 3> slopes{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < num_terms; ++i) {
        const double p = 0.5 * terms[i].alpha, q = 2.0 / 3.0 * p,
                     factor = 0.5 * terms[i].mu / (p * p);
        // The powers contain J^-q. So g has the extended J^-q over J^-q, and g_J its derivative
        // over J^-q.
        const T g = factor * (1.0 - q * d * (1.0 - 0.5 * (q + 1.0) * d)),
                g_J = -q * factor * (1.0 - (q + 1.0) * d) * per_J;
        const T sum = powers.add(p, g, slopes);
        w += g * sum - 3.0 * factor;
        w_J += g_J * sum;
    }
    for (std::size_t k = 0; k < 3; ++k) slopes[k] *= powers.relative[k];
    const auto by = stretches.derivatives(slopes, s);
    return {w, by.a, by.b, w_J + 2.0 * s.J * by.I3};
}

// The stretches are accurate here also where they coincide. The distance that derivatives keep
// between them would leave an energy at rest.
template <class T>
T Ogden::energy_density(const LinkStrain<T>& s, double J0) const {
    constexpr double rounding = 1e-100;
    const double floor = J0 * J0;
    const SquaredStretches<T> stretches(s, rounding, floor);
    const PowersOfStretches<T> powers(stretches.all(), floor, 0.0);
    T w = quadratic_volume_term(s.J, bulk_modulus).value;
    for (std::size_t i = 0; i < num_terms; ++i) {
        const auto [mu, alpha] = terms[i];
        std::array<T, 3> unused{0.0, 0.0, 0.0};
        const T sum = powers.add(0.5 * alpha, 1.0, unused);
        const T isochoric = isochoric_factor(s.J, alpha, J0).value;
        w += 2.0 * mu / (alpha * alpha) * (isochoric * sum - 3.0);
    }
    return w;
}

}  // namespace incise::physics
