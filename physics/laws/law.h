// Hyperelastic laws as functions of the strain of links. docs/adding-a-law.md shows how to add one.
// Responses are templates over the type of number, so that tangents come from the same formulas.
// Source: HEML 2015, section 4, with the corrections listed in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <variant>

#include "incise/physics/laws/custom_law.h"
#include "incise/physics/laws/holzapfel_gasser_ogden.h"
#include "incise/physics/laws/law_response.h"
#include "incise/physics/laws/ogden.h"

namespace incise::physics {

/// w = lambda/2 (tr E)^2 + mu tr(E^2). The stress S is linear in E. The law softens in compression,
/// collapses in uniaxial compression below a stretch of 0.577, and does not resist inversion.
struct SaintVenantKirchhoff {
    double lambda, mu;  ///< Pa
    static constexpr bool needs_J = false;

    double rest_lambda() const { return lambda; }
    double rest_mu() const { return mu; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double /*J0*/) const {
        return {0.125 * lambda * s.a * s.a + 0.25 * mu * s.b, 0.25 * lambda * s.a, 0.25 * mu, 0.0};
    }
};

/// w = C1 (I1 - 3) - 2 C1 ln J + lambda/2 (ln J)^2, so that mu = 2 C1. HEML 2015, eq. (26).
struct NeoHookean {
    double c1, lambda;  ///< Pa
    static constexpr bool needs_b = false;

    double rest_lambda() const { return lambda; }
    double rest_mu() const { return 2.0 * c1; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const auto term = [this](const T& J) {
            return logarithmic_volume_term(J, lambda, 2.0 * c1);
        };
        const VolumeTerm<T> v = extended(term, s.J, J0);
        return {c1 * s.a + v.value, c1, 0.0, v.first};
    }
};

/// w = C1 (I1 - 3) + C2 (I2 - 3) - (2 C1 + 4 C2) ln J + lambda/2 (ln J)^2, so that at rest
/// mu = 2 (C1 + C2) and the Lame parameter is lambda + 4 C2. I2 - 3 = 2a + (a^2 - b)/2.
struct MooneyRivlin {
    double c1, c2, lambda;  ///< Pa

    double rest_lambda() const { return lambda + 4.0 * c2; }
    double rest_mu() const { return 2.0 * (c1 + c2); }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const auto term = [this](const T& J) {
            return logarithmic_volume_term(J, lambda, 2.0 * c1 + 4.0 * c2);
        };
        const VolumeTerm<T> v = extended(term, s.J, J0);
        return {c1 * s.a + c2 * (2.0 * s.a + 0.5 * (s.a * s.a - s.b)) + v.value,
                c1 + c2 * (2.0 + s.a), -0.5 * c2, v.first};
    }
};

/// w = mu/2 (I1 - 3) - (mu + lambda/2) ln J + lambda/4 (J^2 - 1): Ciarlet's form, convex in J.
struct CiarletNeoHookean {
    double mu, lambda;  ///< Pa
    static constexpr bool needs_b = false;

    double rest_lambda() const { return lambda; }
    double rest_mu() const { return mu; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const auto term = [this](const T& J) {
            using std::log;
            const double p = mu + 0.5 * lambda;
            return VolumeTerm<T>{0.25 * lambda * (J * J - 1.0) - p * log(J),
                                 0.5 * lambda * J - p / J, 0.5 * lambda + p / (J * J)};
        };
        const VolumeTerm<T> v = extended(term, s.J, J0);
        return {0.5 * mu * s.a + v.value, 0.5 * mu, 0.0, v.first};
    }
};

/// w = mu/(2 gamma) (exp(gamma (I1 - 3)) - 1) - mu ln J + lambda/2 (ln J)^2: stiffens with strain.
/// At rest the Lame parameters are lambda + 2 mu gamma and mu. HEML 2006, Table 1, corrected.
struct FungDemiray {
    double mu, gamma, lambda;  ///< Pa, 1, Pa
    static constexpr bool needs_b = false;

    double rest_lambda() const { return lambda + 2.0 * mu * gamma; }
    double rest_mu() const { return mu; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const auto term = [this](const T& J) { return logarithmic_volume_term(J, lambda, mu); };
        const VolumeTerm<T> v = extended(term, s.J, J0);
        const Exponential<T> e(gamma * s.a);
        return {0.5 * mu / gamma * e.value + v.value, 0.5 * mu * e.first, 0.0, v.first};
    }
};

/// w = C1 (I1 J^-2/3 - 3) + C2 (I2 J^-4/3 - 3) + K/2 (J - 1)^2; neo-Hookean with C2 = 0. Changes
/// of shape and of volume have separate energies. HEML 2015, eq. (24).
struct IsochoricMooneyRivlin {
    double c1, c2, bulk_modulus;  ///< Pa

    double rest_mu() const { return 2.0 * (c1 + c2); }
    double rest_lambda() const { return bulk_modulus - 2.0 / 3.0 * rest_mu(); }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const auto power = [&](double p) {
            return extended([p](const T& J) { return power_of_volume(J, p); }, s.J, J0);
        };
        const T I1 = 3.0 + s.a, I2 = 3.0 + 2.0 * s.a + 0.5 * (s.a * s.a - s.b);
        const VolumeTerm<T> p1 = power(2.0 / 3.0), p2 = power(4.0 / 3.0),
                            v = quadratic_volume_term(s.J, bulk_modulus);
        return {c1 * (I1 * p1.value - 3.0) + c2 * (I2 * p2.value - 3.0) + v.value,
                c1 * p1.value + c2 * p2.value * (2.0 + s.a), -0.5 * c2 * p2.value,
                c1 * I1 * p1.first + c2 * I2 * p2.first + v.first};
    }
};

/// w = mu/(2 gamma) (exp(gamma (I1 J^-2/3 - 3)) - 1) + K/2 (J - 1)^2.
struct IsochoricFungDemiray {
    double mu, gamma, bulk_modulus;  ///< Pa, 1, Pa
    static constexpr bool needs_b = false;

    double rest_mu() const { return mu; }
    double rest_lambda() const { return bulk_modulus - 2.0 / 3.0 * mu; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const VolumeTerm<T> p =
            extended([](const T& J) { return power_of_volume(J, 2.0 / 3.0); }, s.J, J0);
        const VolumeTerm<T> v = quadratic_volume_term(s.J, bulk_modulus);
        const T I1 = 3.0 + s.a;
        const double slope = 0.5 * mu;
        const Exponential<T> e(gamma * (I1 * p.value - 3.0));
        return {slope / gamma * e.value + v.value, slope * e.first * p.value, 0.0,
                slope * e.first * I1 * p.first + v.first};
    }
};

/// w = c1 i + c2 i^2 + c3 i^3 + K/2 (J - 1)^2 with i = I1 J^-2/3 - 3: stiffens as a polynomial. At
/// rest mu = 2 c1. Source: O. H. Yeoh, Rubber Chemistry and Technology 66 (1993) 754-771.
struct Yeoh {
    double c1, c2, c3, bulk_modulus;  ///< Pa
    static constexpr bool needs_b = false;

    double rest_mu() const { return 2.0 * c1; }
    double rest_lambda() const { return bulk_modulus - 2.0 / 3.0 * rest_mu(); }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const VolumeTerm<T> p =
            extended([](const T& J) { return power_of_volume(J, 2.0 / 3.0); }, s.J, J0);
        const VolumeTerm<T> v = quadratic_volume_term(s.J, bulk_modulus);
        const T I1 = 3.0 + s.a, i = I1 * p.value - 3.0;
        const T slope = c1 + i * (2.0 * c2 + i * 3.0 * c3);
        return {i * (c1 + i * (c2 + i * c3)) + v.value, slope * p.value, 0.0,
                slope * I1 * p.first + v.first};
    }
};

/// w = mu/2 (I1 - 3 - ln((I1 + 1)/4)) - 3/4 mu (J - 1) + lambda/2 (J - 1)^2. The energy is smooth
/// for any deformation, also of flat, inverted or collapsed elements, so it needs no threshold J0.
/// The logarithm removes the stiffness of an element collapsed to a point. Neither a point nor a
/// line is then a minimum of the energy. At rest the shear modulus is 3/4 mu, and the Lame
/// parameter is lambda - 5/8 mu.
/// Source: B. Smith, F. de Goes, T. Kim, Stable Neo-Hookean Flesh Simulation, ACM Transactions on
/// Graphics 37 (2018), eqs. (13) to (16), with a constant added that makes the energy at rest 0.
struct StableNeoHookean {
    double mu, lambda;  ///< Pa; constants of the law, not moduli at rest
    static constexpr bool needs_b = false;

    /// Returns the law that has these Lame parameters at rest, Pa.
    static StableNeoHookean of_rest_moduli(double rest_lambda, double rest_mu) {
        return {4.0 / 3.0 * rest_mu, rest_lambda + 5.0 / 6.0 * rest_mu};
    }
    double rest_lambda() const { return lambda - 0.625 * mu; }
    double rest_mu() const { return 0.75 * mu; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double /*J0*/) const {
        using std::log1p;
        const double p = 0.75 * mu;
        const T change = s.J - 1.0;  // of volume
        return {0.5 * mu * (s.a - log1p(0.25 * s.a)) + change * (0.5 * lambda * change - p),
                0.5 * mu * (1.0 - 1.0 / (4.0 + s.a)), 0.0, lambda * change - p};
    }
};

using Law = std::variant<SaintVenantKirchhoff, NeoHookean, MooneyRivlin, CiarletNeoHookean,
                         FungDemiray, IsochoricMooneyRivlin, IsochoricFungDemiray, Ogden, Yeoh,
                         HolzapfelGasserOgden, StableNeoHookean, CustomLaw>;

/// Returns the response of a law to a strain; see LawResponse. `J0` is the inversion threshold.
LawResponse<double> response(const Law& law, const LinkStrain<double>& strain, double J0);
LawResponse<Dual> response(const Law& law, const LinkStrain<Dual>& strain, double J0);

double rest_lambda(const Law& law);  ///< Pa
double rest_mu(const Law& law);      ///< Pa

/// The contribution of fibres to the stiffness at rest; see HasFibres. Zero for a law without
/// fibres.
struct RestFibres {
    double modulus = 0.0;  ///< Pa
    double dispersion = 0.0;
};
RestFibres rest_fibres(const Law& law);
bool has_fibres(const Law& law);

}  // namespace incise::physics
