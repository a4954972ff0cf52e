// The arguments and results of a law, and the volume terms that several laws share. All are
// templates over the type of number: double, Dual for tangents, Lanes for the fast forces.
// Formulas have no branches, since lanes may differ. They are always inlined, since a call would
// store all lanes in use to memory.
// Source: HEML 2015, section 4, with the corrections listed in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "incise/physics/laws/dual.h"

namespace incise::physics {

/// The strain of one element, as invariants that follow from its links. dl stands for the changes
/// of the six squared edge lengths, E for the Green-Lagrange strain, and C = I + 2E. vtr and Mtr
/// are those of the paper.
template <class T>
struct LinkStrain {
    T a;  ///< vtr . dl = tr(2E) = I1 - 3
    T b;  ///< dl . Mtr dl = tr((2E)^2)
    T J;  ///< current over rest volume; negative if the element is inverted
    /// I4 - 1, with the squared stretch I4 = a0 . C a0 along the fibres; 0 without fibres.
    T f = {};
};

/// Returns the strain with each invariant as a variable, so that results have derivatives by it.
inline LinkStrain<Dual> with_derivatives(const LinkStrain<double>& s) {
    return {Dual::variable(s.a, 0), Dual::variable(s.b, 1), Dual::variable(s.J, 2),
            Dual::variable(s.f, 3)};
}

/// The energy density, J/m3, and its derivatives by the invariants of LinkStrain.
template <class T>
struct LawResponse {
    T w, w_a, w_b, w_J;
    T w_f = {};  ///< only of laws with fibres
};

/// A law with one family of fibres. It needs the direction a0 of the fibres at rest in each
/// element. At small strain, stretched fibres add c/2 (H : strain)^2 to the energy density, with
/// H = dispersion 1 + (1 - 3 dispersion) a0 x a0 and c = rest_fibre_modulus(), Pa.
template <class Law>
concept HasFibres = requires(const Law& law) {
    law.rest_fibre_modulus();
    law.dispersion;
};

/// True if the fast forces have to compute the terms of w_b, or for NeedsJ those of w_J. A law
/// whose w_b is always zero may declare `static constexpr bool needs_b = false;`, and likewise
/// needs_J.
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

/// Returns a volume term that below the threshold J0 is its second-order expansion at J0. Its force
/// is then linear in J, and is finite and restoring through J = 0 and beyond.
///
/// An element recovers from flat and inverted states, but not from a point or a line. An element
/// collapsed to a point is a local minimum of the energy, and one collapsed to a line has no force
/// of volume.
/// Source: HEML 2015, section 4.4, with slope and intercept corrected.
template <class T, class Term>
[[gnu::always_inline]] inline VolumeTerm<T> extended(const Term& term, const T& J, double J0) {
    using std::max;
    const T at = max(J, T(J0)), d = J - at;  // d = 0 above the threshold
    const VolumeTerm<T> t = term(at);
    return {t.value + d * (t.first + 0.5 * d * t.second), t.first + d * t.second, t.second};
}

/// lambda/2 (ln J)^2 - p ln J. Each law has the p that makes it free of stress at rest.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> logarithmic_volume_term(const T& J, double lambda,
                                                                    double p) {
    using std::log;
    const T ln = log(J), per_J = 1.0 / J;
    return {ln * (0.5 * lambda * ln - p), (lambda * ln - p) * per_J,
            (lambda - lambda * ln + p) * per_J * per_J};
}

/// J^-p. Isochoric laws multiply an invariant of strain by it to remove the change of volume.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> power_of_volume(const T& J, double p) {
    using std::pow;
    const T power = pow(J, -p), per_J = 1.0 / J;
    return {power, -p * power * per_J, p * (p + 1.0) * power * per_J * per_J};
}

/// exp(x) - 1 and its derivative. Beyond x = 20, which no tissue reaches, it is the second-order
/// expansion at 20, so that crushed elements have finite forces.
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

/// K/2 (J - 1)^2. It is finite for any J and needs no extension.
template <class T>
[[gnu::always_inline]] inline VolumeTerm<T> quadratic_volume_term(const T& J, double bulk_modulus) {
    return {0.5 * bulk_modulus * (J - 1.0) * (J - 1.0), bulk_modulus * (J - 1.0), bulk_modulus};
}

}  // namespace incise::physics
