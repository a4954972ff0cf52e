// Ogden's law: sums of powers of the principal stretches. The one law that is no plain function of
// the invariants that links give, so its principal stretches are found from these.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>

#include "physics/law_response.h"

namespace incise::physics {

/// w = sum_i 2 mu_i / alpha_i^2 (l1^alpha_i + l2^alpha_i + l3^alpha_i - 3) + K/2 (J - 1)^2, with
/// l_k = J^-1/3 times the principal stretches; the shear modulus at rest is the sum of the mu_i.
/// Squared stretches below the square of the threshold J0 follow a parabola that is level at zero,
/// so that flat elements have finite forces and those turned inside out come back.
struct Ogden {
    static constexpr std::size_t max_terms = 6;
    struct Term {
        double mu, alpha;  ///< Pa, 1; mu alpha may be negative in some terms, not in their sum
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
    /// Cost: some ten times that of the other laws.
    LawResponse<double> response(const LinkStrain<double>& s, double J0) const;
    LawResponse<Dual> response(const LinkStrain<Dual>& s, double J0) const;
};

/// Eigenvalues of the right Cauchy-Green tensor, in ascending order, none below zero.
/// @param s  its invariants; the sign of J does not matter
std::array<double, 3> squared_principal_stretches(const LinkStrain<double>& s);

}  // namespace incise::physics
