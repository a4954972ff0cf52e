// Multiplicative Jacobian energy decomposition. The energy density is a sum of products
// f(J) g(I1, I2). No stress then needs the inverse of C, since the derivative of J by a corner is a
// cross product of edges.
// Source: S. Marchesseau, T. Heimann, S. Chatelin, R. Willinger, H. Delingette, Multiplicative
// Jacobian energy decomposition method for fast porous visco-hyperelastic soft tissue model, MICCAI
// 2010.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cmath>

#include "bench/comparators/element_loop.h"
#include "bench/comparators/tled.h"
#include "incise/physics/laws/law.h"

namespace incise::bench {

/// Sums over the products f g of a law, Pa.
template <class Scalar>
struct ProductSums {
    Scalar by_I1;  ///< of f dg/dI1
    Scalar by_I2;  ///< of f dg/dI2
    Scalar by_J;   ///< of f' g
};

/// 1 [lambda/8 (I1 - 3)^2 + mu/4 (I1^2 - 2 I1 - 2 I2 + 3)]
template <class Scalar>
ProductSums<Scalar> products(const physics::SaintVenantKirchhoff& law, Scalar I1, Scalar, Scalar) {
    return {0.25 * law.lambda * (I1 - 3.0) + 0.5 * law.mu * (I1 - 1.0), -0.5 * law.mu, 0.0};
}
/// 1 [C1 (I1 - 3)] + [lambda/2 (ln J)^2 - 2 C1 ln J] 1
template <class Scalar>
ProductSums<Scalar> products(const physics::NeoHookean& law, Scalar, Scalar, Scalar J) {
    using std::log;
    return {law.c1, 0.0, (law.lambda * log(J) - 2.0 * law.c1) / J};
}
/// 1 [C1 (I1 - 3) + C2 (I2 - 3)] + [lambda/2 (ln J)^2 - (2 C1 + 4 C2) ln J] 1
template <class Scalar>
ProductSums<Scalar> products(const physics::MooneyRivlin& law, Scalar, Scalar, Scalar J) {
    using std::log;
    return {law.c1, law.c2, (law.lambda * log(J) - (2.0 * law.c1 + 4.0 * law.c2)) / J};
}
/// J^-2/3 [C1 I1] + J^-4/3 [C2 I2] + [K/2 (J - 1)^2 - 3 C1 - 3 C2] 1, the example of the paper
inline ProductSums<double> products(const physics::IsochoricMooneyRivlin& law, double I1, double I2,
                                    double J) {
    const double f = 1.0 / std::cbrt(J * J);
    return {
        law.c1 * f, law.c2 * f * f,
        -2.0 / 3.0 * f / J * (law.c1 * I1 + 2.0 * law.c2 * I2 * f) + law.bulk_modulus * (J - 1.0)};
}

/// True if the stress has a term with C, from I1^2 or I2.
template <class Law>
constexpr bool has_C = !std::is_same_v<Law, physics::NeoHookean>;
/// True if a factor f depends on J.
template <class Law>
constexpr bool has_J = !std::is_same_v<Law, physics::SaintVenantKirchhoff>;

/// The forces of one tetrahedron.
/// @pre J > 0, except for Saint Venant-Kirchhoff tissue
template <class Scalar, class Law>
struct Mjed {
    using Element = typename Tled<Scalar, Law>::Element;

    Law law;

    Element precompute(const Corners<double>& X) const {
        return Tled<Scalar, Law>{law}.precompute(X);
    }

    /// f_i = -Vol [ F (sum of f 2 dg/dC) grad N_i + (sum of f' g) dJ/dx_i ].
    Corners<Scalar> forces(const Element& e, const Corners<Scalar>& x) const {
        const Vector<Scalar> v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
        Matrix<Scalar> edges;
        edges << v1, v2, v3;
        const Matrix<Scalar> F = edges * e.gradients;
        Matrix<Scalar> C;
        Scalar I1(3.0), I2(3.0), J(1.0);
        if constexpr (has_C<Law>) {
            C = right_cauchy_green(F);
            I1 = C.trace();
        }
        if constexpr (std::is_same_v<Law, physics::IsochoricMooneyRivlin>)
            I2 = 0.5 * (I1 * I1 - C.squaredNorm());
        Vector<Scalar> n1;
        if constexpr (has_J<Law>) {
            n1 = v2.cross(v3);
            J = v1.dot(n1) / (6.0 * e.volume);
        }
        const ProductSums<Scalar> sums = products(law, I1, I2, J);

        // dI1/dC = 1, dI2/dC = I1 1 - C.
        const Scalar scale = -2.0 * e.volume;
        Matrix<Scalar> P;
        if constexpr (has_C<Law>) {
            const Scalar of_C = scale * sums.by_I2;
            Matrix<Scalar> S;
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j <= i; ++j) S(i, j) = S(j, i) = -(of_C * C(i, j));
            const Scalar diagonal = scale * sums.by_I1 + of_C * I1;
            for (int i = 0; i < 3; ++i) S(i, i) += diagonal;
            P = F * S;
        } else {
            P = (scale * sums.by_I1) * F;
        }
        Matrix<Scalar> f = P * e.gradients.transpose();
        if constexpr (has_J<Law>) {  // Vol dJ/dx_i = dvol/dx_i
            const Scalar p = sums.by_J / 6.0;
            f.col(0) -= p * n1;
            f.col(1) -= p * v3.cross(v1);
            f.col(2) -= p * v1.cross(v2);
        }
        return {-(f.col(0) + f.col(1) + f.col(2)), f.col(0), f.col(1), f.col(2)};
    }
};

}  // namespace incise::bench
