// Total Lagrangian explicit dynamics: forces by the second Piola-Kirchhoff stress and gradients of
// shape functions, both in the rest frame.
// Source: K. Miller, G. Joldes, D. Lance, A. Wittek, Total Lagrangian explicit dynamics finite
// element algorithm for computing soft tissue deformation, Communications in Numerical Methods in
// Engineering 23, 2007. Its B_L^T S of a corner is F S grad N.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>
#include <type_traits>

#include "bench/comparators/element_loop.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Returns C = F^T F from six scalar products, not nine.
template <class Scalar>
Matrix<Scalar> right_cauchy_green(const Matrix<Scalar>& F) {
    Matrix<Scalar> C;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) C(i, j) = C(j, i) = F.col(i).dot(F.col(j));
    return C;
}

/// Returns C^-1 by cofactors, from C and J^2 = det C.
template <class Scalar>
Matrix<Scalar> inverse_of_symmetric(const Matrix<Scalar>& C, Scalar determinant) {
    const Scalar scale = 1.0 / determinant;
    Matrix<Scalar> inverse;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) {
            const int k = (i + 1) % 3, l = (i + 2) % 3, m = (j + 1) % 3, n = (j + 2) % 3;
            inverse(i, j) = inverse(j, i) = scale * (C(k, m) * C(l, n) - C(k, n) * C(l, m));
        }
    return inverse;
}

/// Returns the second Piola-Kirchhoff stress, Pa, from C and J. Saint Venant-Kirchhoff tissue does
/// not use J.
/// @pre J > 0 for the other laws
template <class Scalar>
Matrix<Scalar> second_piola_kirchhoff(const physics::SaintVenantKirchhoff& law,
                                      const Matrix<Scalar>& C, Scalar) {
    Matrix<Scalar> S;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < i; ++j) S(i, j) = S(j, i) = law.mu * C(i, j);
        S(i, i) = law.mu * (C(i, i) - 1.0);
    }
    const Scalar pressure = 0.5 * law.lambda * (C.trace() - 3.0);
    for (int i = 0; i < 3; ++i) S(i, i) += pressure;
    return S;
}
template <class Scalar>
Matrix<Scalar> second_piola_kirchhoff(const physics::NeoHookean& law, const Matrix<Scalar>& C,
                                      Scalar J) {
    using std::log;
    Matrix<Scalar> S = inverse_of_symmetric<Scalar>(C, J * J);
    const Scalar scale = law.lambda * log(J) - 2.0 * law.c1;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) S(j, i) = S(i, j) *= scale;
    for (int i = 0; i < 3; ++i) S(i, i) += 2.0 * law.c1;
    return S;
}
template <class Scalar>
Matrix<Scalar> second_piola_kirchhoff(const physics::MooneyRivlin& law, const Matrix<Scalar>& C,
                                      Scalar J) {
    using std::log;
    Matrix<Scalar> S = inverse_of_symmetric<Scalar>(C, J * J);
    const Scalar scale = law.lambda * log(J) - (2.0 * law.c1 + 4.0 * law.c2);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j <= i; ++j) S(j, i) = S(i, j) = scale * S(i, j) - 2.0 * law.c2 * C(i, j);
    const Scalar diagonal = 2.0 * law.c1 + 2.0 * law.c2 * C.trace();
    for (int i = 0; i < 3; ++i) S(i, i) += diagonal;
    return S;
}

/// The forces of one tetrahedron, with one integration point. The deformation gradient comes from
/// the three edges at corner 0, and the force on corner 0 is minus the sum of the others. In exact
/// arithmetic this equals the form with four displacements, and takes fewer operations.
template <class Scalar, class Law>
struct Tled {
    struct Element {
        Scalar volume;                                           ///< m3
        Eigen::Matrix<Scalar, 3, 3, Eigen::RowMajor> gradients;  ///< of N_1 to N_3, 1/m
    };

    Law law;

    Element precompute(const Corners<double>& X) const {
        const ShapeFunctions N(X);
        return {N.volume, N.rows.cast<Scalar>()};
    }

    Corners<Scalar> forces(const Element& e, const Corners<Scalar>& x) const {
        Matrix<Scalar> edges;
        edges << x[1] - x[0], x[2] - x[0], x[3] - x[0];
        const Matrix<Scalar> F = edges * e.gradients;
        const Matrix<Scalar> C = right_cauchy_green(F);
        Scalar J(1.0);
        if constexpr (!std::is_same_v<Law, physics::SaintVenantKirchhoff>)
            J = F.col(0).dot(F.col(1).cross(F.col(2)));
        const Matrix<Scalar> S = second_piola_kirchhoff<Scalar>(law, C, J);
        const Matrix<Scalar> scaled = -e.volume * F;  // separate: Eigen would scale it three times
        const Matrix<Scalar> P = scaled * S;
        const Matrix<Scalar> f = P * e.gradients.transpose();
        return {-(f.col(0) + f.col(1) + f.col(2)), f.col(0), f.col(1), f.col(2)};
    }
};

}  // namespace incise::bench
