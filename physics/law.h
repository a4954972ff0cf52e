// Hyperelastic laws as functions of link lengths. A new law is one struct here and one alternative
// of Law; docs/architecture.md lists what gives it its name and parameters in a scenario.
// Source: HEML 2015, section 4, with the corrections listed in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <variant>

namespace incise::physics {

/// Strain of one element as its links see it. With dl the changes of the six squared edge
/// lengths, E the Green-Lagrange strain and C = I + 2E:
struct LinkStrain {
    double a;  ///< vtr . dl = tr(2E) = I1 - 3
    double b;  ///< dl . Mtr dl = tr((2E)^2)
    double J;  ///< current over rest volume; negative when inverted
};

/// Energy density per rest volume (J/m3) and its derivatives.
struct LawResponse {
    double w, w_a, w_b, w_J;
};

/// A function of J with its first two derivatives.
struct VolumeTerm {
    double value, first, second;
};

/// Below the threshold J0 a volume term follows its second-order expansion there, so that its
/// force is the tangent at J0: finite and restoring through J = 0 and beyond.
/// Source: HEML 2015, section 4.4, with slope and intercept corrected. An element collapsed to a
/// point is a local minimum of this extension, and one collapsed to a line feels no force of
/// volume: it recovers from flat and turned states, not from those two.
template <class Term>
VolumeTerm extended(const Term& term, double J, double J0) {
    if (J > J0) return term(J);
    const VolumeTerm t = term(J0);
    const double d = J - J0;
    return {t.value + d * (t.first + 0.5 * d * t.second), t.first + d * t.second, t.second};
}

/// lambda/2 (ln J)^2 - p ln J: p is chosen by each law so that it is free of stress at rest.
inline VolumeTerm logarithmic_volume_term(double J, double lambda, double p) {
    const double ln = std::log(J);
    return {ln * (0.5 * lambda * ln - p), (lambda * ln - p) / J,
            (lambda - lambda * ln + p) / (J * J)};
}

/// w = lambda/2 (tr E)^2 + mu tr(E^2). Linear in E; softens in compression below a stretch of
/// 0.577 and does not resist inversion.
struct SaintVenantKirchhoff {
    double lambda, mu;  ///< Pa

    double rest_lambda() const { return lambda; }
    double rest_mu() const { return mu; }
    LawResponse response(const LinkStrain& s, double /*J0*/) const {
        return {0.125 * lambda * s.a * s.a + 0.25 * mu * s.b, 0.25 * lambda * s.a, 0.25 * mu, 0.0};
    }
};

/// w = C1 (I1 - 3) - 2 C1 ln J + lambda/2 (ln J)^2, so that mu = 2 C1. HEML 2015, eq. (26).
struct NeoHookean {
    double c1, lambda;  ///< Pa

    double rest_lambda() const { return lambda; }
    double rest_mu() const { return 2.0 * c1; }
    LawResponse response(const LinkStrain& s, double J0) const {
        const auto term = [this](double J) { return logarithmic_volume_term(J, lambda, 2.0 * c1); };
        const VolumeTerm v = extended(term, s.J, J0);
        return {c1 * s.a + v.value, c1, 0.0, v.first};
    }
};

/// w = C1 (I1 - 3) + C2 (I2 - 3) - (2 C1 + 4 C2) ln J + lambda/2 (ln J)^2, so that at rest
/// mu = 2 (C1 + C2) and the Lame constant is lambda + 4 C2. I2 - 3 = 2a + (a^2 - b)/2.
struct MooneyRivlin {
    double c1, c2, lambda;  ///< Pa

    double rest_lambda() const { return lambda + 4.0 * c2; }
    double rest_mu() const { return 2.0 * (c1 + c2); }
    LawResponse response(const LinkStrain& s, double J0) const {
        const auto term = [this](double J) {
            return logarithmic_volume_term(J, lambda, 2.0 * c1 + 4.0 * c2);
        };
        const VolumeTerm v = extended(term, s.J, J0);
        return {c1 * s.a + c2 * (2.0 * s.a + 0.5 * (s.a * s.a - s.b)) + v.value,
                c1 + c2 * (2.0 + s.a), -0.5 * c2, v.first};
    }
};

using Law = std::variant<SaintVenantKirchhoff, NeoHookean, MooneyRivlin>;

}  // namespace incise::physics
