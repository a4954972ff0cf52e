// Soft tissue with one family of collagen fibres, parallel or dispersed about their direction.
// Source: T. C. Gasser, R. W. Ogden, G. A. Holzapfel, Journal of the Royal Society Interface 3
// (2006) 15-35. The strain of the fibres has full, not isochoric, invariants: docs/theory.md,
// Fibres.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/laws/law_response.h"

namespace incise::physics {

/// w = mu/2 (I1 J^-2/3 - 3) + K/2 (J - 1)^2 + k1/(2 k2) (exp(k2 E^2) - 1).
/// The last term is zero for E <= 0, since fibres carry no compression.
/// E = kappa (I1 - 3) + (1 - 3 kappa) (I4 - 1) is the mean squared stretch of the fibres, less 1.
/// I4 = a0 . C a0, with the direction a0 of the fibres at rest.
/// mu and K are those of the ground substance, which alone resists a compression along the fibres.
struct HolzapfelGasserOgden {
    double mu, bulk_modulus;  ///< Pa
    double k1, k2;            ///< Pa, 1; above 0
    double dispersion = 0.0;  ///< kappa, from 0 (parallel) to 1/3 (in all directions alike)

    static constexpr bool needs_b = false;

    double rest_mu() const { return mu; }
    double rest_lambda() const { return bulk_modulus - 2.0 / 3.0 * mu; }
    double rest_fibre_modulus() const { return 4.0 * k1; }
    template <class T>
    LawResponse<T> response(const LinkStrain<T>& s, double J0) const {
        const VolumeTerm<T> p =
            extended([](const T& J) { return power_of_volume(J, 2.0 / 3.0); }, s.J, J0);
        const VolumeTerm<T> v = quadratic_volume_term(s.J, bulk_modulus);
        const T I1 = 3.0 + s.a;
        const double slope = 0.5 * mu, along = 1.0 - 3.0 * dispersion;
        LawResponse<T> r{slope * (I1 * p.value - 3.0) + v.value, slope * p.value, 0.0,
                         slope * I1 * p.first + v.first};
        using std::max;
        const T E = max(dispersion * s.a + along * s.f, T(0.0));
        const Exponential<T> e(k2 * E * E);
        const T tension = k1 * E * e.first;
        r.w += 0.5 * k1 / k2 * e.value;
        r.w_a += dispersion * tension;
        r.w_f = along * tension;
        return r;
    }
};

}  // namespace incise::physics
