// How much stiffer a law is at a strain than at rest: the factor by which the bound of the stable
// step grows. Equations: docs/theory.md, Stable step.
// Like the laws, these are templates over the type of number, without branches.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "incise/physics/laws/dual_of.h"
#include "incise/physics/laws/law.h"
#include "incise/physics/laws/squared_stretches.h"

namespace incise::physics {

/// The principal stretches of an element and their squares. The first stretch is negative if the
/// element is inverted.
template <class T>
struct PrincipalStretches {
    std::array<T, 3> stretches, squares;

    /// @param s         the strain
    /// @param rounding  as for SquaredStretches
    [[gnu::always_inline]] inline PrincipalStretches(const LinkStrain<T>& s, double rounding) {
        using std::max, std::sqrt;
        constexpr double floor = 1e-6;  // any size far below that of an element at rest
        squares = SquaredStretches<T>(s, rounding, floor).all();
        for (std::size_t i = 0; i < 3; ++i) {
            squares[i] = max(squares[i], T(0.0));
            stretches[i] = sqrt(squares[i]);
        }
        stretches[0] = choose(is_less(s.J, T(0.0)), T(-stretches[0]), stretches[0]);
    }
    /// Returns the largest squared stretch.
    T largest_square() const {
        using std::max;
        return max(max(squares[0], squares[1]), squares[2]);
    }
};

/// The second derivatives of an isotropic energy density by the deformation gradient, Pa, in its
/// principal frame. The entry of a pair is at the index of the direction that it leaves out.
template <class T>
struct PrincipalModuli {
    std::array<T, 3> normal;             ///< by F_ii twice
    std::array<T, 3> coupling;           ///< by F_ii and F_jj
    std::array<T, 3> shear, transposed;  ///< by F_ij twice, and by F_ij and F_ji

    /// Returns lambda + 2 mu of the least isotropic moduli that are not below these. The stiffness
    /// between two corners of a tetrahedron has at most the norm of this modulus times
    /// Vol / (h_i h_j): docs/theory.md, Stable step.
    [[gnu::always_inline]] inline T largest() const {
        using std::abs, std::max;
        T largest_normal = 0.0, lambda = 0.0, mu = 0.0;
        for (std::size_t i = 0; i < 3; ++i) {
            largest_normal = max(largest_normal, abs(normal[i]));
            lambda = max(lambda, abs(coupling[i]));
            mu = max(mu, max(abs(shear[i]), abs(transposed[i])));
        }
        return max(largest_normal, T(lambda + 2.0 * mu));
    }
};

/// Returns the moduli from the derivatives of the energy density by the invariants a, b and J.
template <class T, std::size_t n>
[[gnu::always_inline]] inline PrincipalModuli<T> principal_moduli(
    const LawResponse<DualOf<T, n>>& r, const PrincipalStretches<T>& at) {
    constexpr std::size_t J = n - 1;  // its number; a is variable 0, and b, if it is one, 1
    const auto& l = at.stretches;
    const auto& c = at.squares;
    std::array<std::array<T, 3>, n> by_stretch;  // derivatives of the invariants
    for (std::size_t i = 0; i < 3; ++i) {
        by_stretch[0][i] = 2.0 * l[i];
        if constexpr (n == 3) by_stretch[1][i] = T(4.0 * l[i]) * T(c[i] - 1.0);
        by_stretch[J][i] = l[(i + 1) % 3] * l[(i + 2) % 3];
    }
    const auto second = [&](std::size_t i, std::size_t j) -> T {
        T sum = 0.0;
        const auto add = [&](std::size_t p, const DualOf<T, n>& derivative) {
            for (std::size_t q = 0; q < n; ++q)
                sum += T(by_stretch[p][i] * by_stretch[q][j]) * derivative.gradient[q];
        };
        add(0, r.w_a);
        if constexpr (n == 3) add(1, r.w_b);
        add(J, r.w_J);
        return sum;
    };
    const T w_a = r.w_a.value, w_b = r.w_b.value, w_J = r.w_J.value;
    PrincipalModuli<T> moduli;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const T of_volume = w_J * l[k];
        moduli.normal[k] = second(k, k) + 2.0 * w_a;
        moduli.coupling[k] = second(i, j) + of_volume;
        moduli.shear[k] = 2.0 * w_a;
        moduli.transposed[k] = -of_volume;
        if constexpr (n == 3) {
            moduli.normal[k] += T(4.0 * w_b) * T(T(3.0 * c[k]) - 1.0);
            moduli.shear[k] += T(4.0 * w_b) * T(c[i] + c[j] - 1.0);
            moduli.transposed[k] += T(4.0 * w_b) * T(l[i] * l[j]);
        }
    }
    return moduli;
}

/// Returns the largest modulus of an isotropic law at a strain, Pa; see PrincipalModuli::largest.
template <class Law, class T>
[[gnu::always_inline]] inline T largest_modulus(const Law& law, const LinkStrain<T>& s, double J0,
                                                const PrincipalStretches<T>& at) {
    constexpr std::size_t n = NeedsB<Law> ? 3 : 2;
    using Number = DualOf<T, n>;
    LinkStrain<Number> strain{Number::variable(s.a, 0), 0.0, Number::variable(s.J, n - 1)};
    if constexpr (n == 3) strain.b = Number::variable(s.b, 1);
    return principal_moduli(law.response(strain, J0), at).largest();
}

/// Returns the factor by which the stiffness of an element is larger than at rest, at most. It is 1
/// at rest.
template <class Law, class T>
[[gnu::always_inline]] inline T stiffening(const Law& law, const LinkStrain<T>& s, double J0,
                                           double rounding) {
    const double at_rest = std::abs(law.rest_lambda()) + 2.0 * law.rest_mu();
    return largest_modulus(law, s, J0, PrincipalStretches<T>(s, rounding)) * T(1.0 / at_rest);
}

/// Returns the same for fibres in a ground substance. Each of both stiffens by a factor of its own.
template <class T>
[[gnu::always_inline]] inline T stiffening(const HolzapfelGasserOgden& law, const LinkStrain<T>& s,
                                           double J0, double rounding) {
    using std::abs, std::max;
    using Number = DualOf<T, 1>;
    const PrincipalStretches<T> at(s, rounding);
    const Yeoh ground{0.5 * law.mu, 0.0, 0.0, law.bulk_modulus};
    const double kappa = law.dispersion;
    const Number E = max(Number::variable(kappa * s.a + (1.0 - 3.0 * kappa) * s.f, 0), Number(0.0));
    const Number tension = law.k1 * E * Exponential<Number>(law.k2 * E * E).first;
    // H, whose largest eigenvalue is 1 - 2 kappa, times twice the tension adds to the shear moduli.
    const T modulus =
        largest_modulus(ground, s, J0, at) + 2.0 * (1.0 - 2.0 * kappa) * tension.value;
    const double at_rest = abs(law.rest_lambda()) + 2.0 * law.rest_mu();
    // Parallel fibres follow their own stretch, and dispersed ones at most the largest.
    const T square = kappa == 0.0 ? T(s.f + 1.0) : at.largest_square();
    return max(T(modulus * T(1.0 / at_rest)), T(tension.gradient[0] * T(square * T(1.0 / law.k1))));
}

/// Returns the same for Ogden's law. The moduli of shear are divided differences of its slopes.
/// Each is between the derivatives of the slope at the two stretches, which bound it also where
/// these coincide.
template <class T>
[[gnu::always_inline]] inline T stiffening(const Ogden& law, const LinkStrain<T>& s, double J0,
                                           double rounding) {
    using std::abs, std::exp, std::log, std::max, std::min;
    const PrincipalStretches<T> at(s, rounding);
    const auto& l = at.stretches;
    const auto& c = at.squares;
    const double floor = J0 * J0;
    std::array<T, 3> bounded, logs, J_l;  // J_l is dJ/dl
    for (std::size_t k = 0; k < 3; ++k) {
        bounded[k] = max(c[k], T(floor));
        logs[k] = log(bounded[k]);
        J_l[k] = l[(k + 1) % 3] * l[(k + 2) % 3];
    }
    PrincipalModuli<T> moduli;
    moduli.normal.fill(0.0);
    moduli.coupling.fill(0.0);
    std::array<T, 3> shear_low, shear_high, transposed_low, transposed_high;
    for (auto* all : {&shear_low, &shear_high, &transposed_low, &transposed_high}) all->fill(0.0);
    T w_J = law.bulk_modulus * (s.J - 1.0), w_JJ = law.bulk_modulus;
    for (std::size_t t = 0; t < law.num_terms; ++t) {
        const auto [mu, alpha] = law.terms[t];
        const double p = 0.5 * alpha, factor = 2.0 * mu / (alpha * alpha);
        const VolumeTerm<T> g = isochoric_factor(s.J, alpha, J0);
        const T twice = 2.0 * factor * g.value, with_J = 2.0 * factor * g.first;
        // h(c) = c^p or its parabola, h'(c), and bounds of h''(c) and (c h'(c))'
        std::array<T, 3> slope, second, low, high, c_low, c_high;
        T sum = 0.0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto is_below = is_less(c[k], T(floor));
            const T power = p * exp(T((p - 2.0) * logs[k]));
            const T d = T(min(c[k], T(floor)) - floor) * T(1.0 / floor);
            sum += T(power * T(bounded[k] * bounded[k])) * T(1.0 / p + T(d * T(1.0 + 0.5 * d)));
            slope[k] = power * c[k];
            const T above = (p - 1.0) * power, c_above = p * power * bounded[k];
            second[k] = choose(is_below, power, above);
            const T c_second = choose(is_below, T(2.0 * slope[k]), c_above);
            low[k] = min(above, second[k]);
            high[k] = max(above, second[k]);
            c_low[k] = min(c_above, c_second);
            c_high[k] = max(c_above, c_second);
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const auto add = [&](const T& a, const T& b, const T& by, T& to_low, T& to_high) {
                to_low += min(T(by * a), T(by * b));
                to_high += max(T(by * a), T(by * b));
            };
            const T distance = c[i] - c[j];
            const auto is_apart = is_less(0.1 * T(c[i] + c[j]), abs(distance));
            const T per_distance = T(1.0) / choose(is_apart, distance, T(1.0));
            const T c_exact = T(T(c[i] * slope[i]) - T(c[j] * slope[j])) * per_distance,
                    exact = T(slope[i] - slope[j]) * per_distance;
            add(choose(is_apart, c_exact, min(c_low[i], c_low[j])),
                choose(is_apart, c_exact, max(c_high[i], c_high[j])), twice, shear_low[k],
                shear_high[k]);
            add(choose(is_apart, exact, min(low[i], low[j])),
                choose(is_apart, exact, max(high[i], high[j])), T(twice * T(l[i] * l[j])),
                transposed_low[k], transposed_high[k]);
            moduli.normal[k] += T(twice * T(slope[k] + 2.0 * T(c[k] * second[k]))) +
                                T(2.0 * with_J) * T(T(l[k] * slope[k]) * J_l[k]);
            moduli.coupling[k] +=
                with_J * T(T(T(l[i] * slope[i]) * J_l[j]) + T(T(l[j] * slope[j]) * J_l[i]));
        }
        w_J += T(factor * g.first) * sum;
        w_JJ += T(factor * g.second) * sum;
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
        const T of_volume = w_J * l[k];
        moduli.normal[k] += w_JJ * T(J_l[k] * J_l[k]);
        moduli.coupling[k] += T(w_JJ * T(J_l[i] * J_l[j])) + of_volume;
        moduli.shear[k] = max(abs(shear_low[k]), abs(shear_high[k]));
        moduli.transposed[k] =
            max(abs(T(transposed_low[k] - of_volume)), abs(T(transposed_high[k] - of_volume)));
    }
    const double at_rest = abs(law.rest_lambda()) + 2.0 * law.rest_mu();
    return moduli.largest() * T(1.0 / at_rest);
}

/// Returns the same for the law of a program. It is no template: Dual has another layout in files
/// that are compiled for one kind of processor.
double stiffening(const CustomLaw& law, const LinkStrain<double>& s, double J0);
/// Returns the same, one element after the other.
template <class T>
T stiffening(const CustomLaw& law, const LinkStrain<T>& s, double J0, double /*rounding*/) {
    if constexpr (std::is_same_v<T, double>) {
        return stiffening(law, s, J0);
    } else {
        T all = 0.0;
        for (int lane = 0; lane < T::size; ++lane) {
            using Number = std::remove_cvref_t<decltype(s.a.v[lane])>;
            const LinkStrain<double> one{s.a.v[lane], s.b.v[lane], s.J.v[lane]};
            all.v[lane] = static_cast<Number>(stiffening(law, one, J0));
        }
        return all;
    }
}

/// Returns the same for any law, in doubles: the reference of the fast version.
double stiffening(const Law& law, const LinkStrain<double>& strain, double J0);

}  // namespace incise::physics
