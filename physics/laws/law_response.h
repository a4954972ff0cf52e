// What a law is asked and answers, and the terms of volume that several laws have. All are
// templates over the kind of number: plain ones, Dual for tangents, Lanes for the fast forces.
// Formulas have no branches, as lanes may differ; and are inlined always, as a call would have the
// lanes of all that is at work go through memory.
// Source: HEML 2015, section 4, with the corrections listed in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "incise/physics/laws/dual.h"

namespace incise::physics {

/// Strain of one element as its links see it. With dl the changes of the six squared edge
/// lengths, E the Green-Lagrange strain and C = I + 2E:
template <class T>
struct LinkStrain {
    T a;  ///< vtr . dl = tr(2E) = I1 - 3, with the vtr and Mtr of the paper
    T b;  ///< dl . Mtr dl = tr((2E)^2)
    T J;  ///< current over rest volume; negative when inverted
    /// I4 - 1, I4 = a0 . C a0 being the squared stretch along the fibres; 0 without fibres.
    T f = {};
};

/// The same strain in numbers that carry their derivatives by it.
inline LinkStrain<Dual> with_derivatives(const LinkStrain<double>& s) {
    return {Dual::variable(s.a, 0), Dual::variable(s.b, 1), Dual::variable(s.J, 2),
            Dual::variable(s.f, 3)};
}

/// Energy density per rest volume (J/m3) and its derivatives.
template <class T>
struct LawResponse {
    T w, w_a, w_b, w_J;
    T w_f = {};  ///< of laws with fibres
};

/// A law with one family of fibres, which asks for their direction at rest in each element. About
/// rest they add c/2 (H : strain)^2 to the energy density where they are stretched, with
/// H = dispersion 1 + (1 - 3 dispersion) a0 x a0 and c the modulus asked for here, Pa.
template <class Law>
concept HasFibres = requires(const Law& law) {
    law.rest_fibre_modulus();
    law.dispersion;
};

/// Whether the fast forces have to work out the terms of w_b and of w_J. A law where one of them is
/// zero throughout may say so: `static constexpr bool needs_b = false;`, or needs_J.
template <class Law>
concept NeedsB = !requires {
    requires !Law::needs_b;
};
template <class Law>
concept NeedsJ = !requires {
    requires !Law::needs_J;
};

/// A function of J with its first two derivatives.
template <class T>
struct VolumeTerm {
    T value, first, second;
};

/// Below the threshold J0 a volume term follows its second-order expansion there, so that its
/// force is the tangent at J0: finite and restoring through J = 0 and beyond.
/// Source: HEML 2015, section 4.4, with slope and intercept corrected. An element collapsed to a
/// point is a local minimum of this extension, and one collapsed to a line feels no force of
/// volume: it recovers from flat and turned states, not from those two.
template <class T, class Term>
[[gnu::always_inline]] inline VolumeTerm<T> extended(const Term& term, const T& J, double J0) {
    using std::max;
    const T at = max(J, T(J0)), d = J - at;  // d = 0 above the threshold
    const VolumeTerm<T> t = term(at);
    return {t.value + d * (t.first + 0.5 * d * t.second), t.first + d * t.second, t.second};
}

/// lambda/2 (ln J)^2 - p ln J: p is chosen by each law so that it is free of stress at rest.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> logarithmic_volume_term(const T& J, double lambda,
                                                                    double p) {
    using std::log;
    const T ln = log(J), per_J = 1.0 / J;
    return {ln * (0.5 * lambda * ln - p), (lambda * ln - p) * per_J,
            (lambda - lambda * ln + p) * per_J * per_J};
}

/// J^-p, by which isochoric laws take the change of volume out of an invariant of strain.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> power_of_volume(const T& J, double p) {
    using std::pow;
    const T power = pow(J, -p), per_J = 1.0 / J;
    return {power, -p * power * per_J, p * (p + 1.0) * power * per_J * per_J};
}

/// exp(x) - 1 and its derivative; beyond x = 20, where no tissue gets, the second-order expansion
/// there, so that crushed elements have finite forces.
template <class T>
struct Exponential {
    T value, first;

    explicit Exponential(const T& x) {
        using std::exp, std::expm1, std::min;
        const T at = min(x, T(20.0)), d = x - at, e = exp(at);
        value = expm1(at) + e * d * (1.0 + 0.5 * d);
        first = e * (1.0 + d);
    }
};

/// K/2 (J - 1)^2: finite for any J.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> quadratic_volume_term(const T& J, double bulk_modulus) {
    return {0.5 * bulk_modulus * (J - 1.0) * (J - 1.0), bulk_modulus * (J - 1.0), bulk_modulus};
}

}  // namespace incise::physics
