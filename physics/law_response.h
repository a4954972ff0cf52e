// What a law is asked and answers, and the terms of volume that several laws have.
// Source: HEML 2015, section 4, with the corrections listed in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

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

/// J^-p, by which isochoric laws take the change of volume out of an invariant of strain.
inline VolumeTerm power_of_volume(double J, double p) {
    const double power = std::pow(J, -p);
    return {power, -p * power / J, p * (p + 1.0) * power / (J * J)};
}

/// K/2 (J - 1)^2: finite for any J.
inline VolumeTerm quadratic_volume_term(double J, double bulk_modulus) {
    return {0.5 * bulk_modulus * (J - 1.0) * (J - 1.0), bulk_modulus * (J - 1.0), bulk_modulus};
}

}  // namespace incise::physics
