// Energy densities as textbooks write them, in terms of the deformation gradient: what the laws,
// which see links, are tested against.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "incise/physics/elements/spectrum.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {

inline double energy_density(const SaintVenantKirchhoff& law, const Mat3& F) {
    const Mat3 E = 0.5 * (F.transpose() * F - Mat3::Identity());
    return 0.5 * law.lambda * E.trace() * E.trace() + law.mu * (E * E).trace();
}
inline double energy_density(const NeoHookean& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    return law.c1 * (F.squaredNorm() - 3.0) - 2.0 * law.c1 * ln + 0.5 * law.lambda * ln * ln;
}
inline double energy_density(const MooneyRivlin& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    const Mat3 C = F.transpose() * F;
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
    return law.c1 * (I1 - 3.0) + law.c2 * (I2 - 3.0) - (2.0 * law.c1 + 4.0 * law.c2) * ln +
           0.5 * law.lambda * ln * ln;
}

inline double energy_density(const CiarletNeoHookean& law, const Mat3& F) {
    const double J = F.determinant();
    return 0.5 * law.mu * (F.squaredNorm() - 3.0) - (law.mu + 0.5 * law.lambda) * std::log(J) +
           0.25 * law.lambda * (J * J - 1.0);
}
inline double energy_density(const FungDemiray& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    return 0.5 * law.mu / law.gamma * (std::exp(law.gamma * (F.squaredNorm() - 3.0)) - 1.0) -
           law.mu * ln + 0.5 * law.lambda * ln * ln;
}
inline double energy_density(const IsochoricMooneyRivlin& law, const Mat3& F) {
    const double J = F.determinant();
    const Mat3 C = std::pow(J, -2.0 / 3.0) * F.transpose() * F;
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
    return law.c1 * (I1 - 3.0) + law.c2 * (I2 - 3.0) + 0.5 * law.bulk_modulus * (J - 1) * (J - 1);
}
inline double energy_density(const IsochoricFungDemiray& law, const Mat3& F) {
    const double J = F.determinant();
    const double I1 = std::pow(J, -2.0 / 3.0) * F.squaredNorm();
    return 0.5 * law.mu / law.gamma * (std::exp(law.gamma * (I1 - 3.0)) - 1.0) +
           0.5 * law.bulk_modulus * (J - 1) * (J - 1);
}
inline double energy_density(const Ogden& law, const Mat3& F) {
    const double J = F.determinant();
    const Vec3 stretches = spectrum(F.transpose() * F).values.cwiseSqrt() / std::cbrt(J);
    double w = 0.5 * law.bulk_modulus * (J - 1) * (J - 1);
    for (std::size_t i = 0; i < law.num_terms; ++i) {
        const auto [mu, alpha] = law.terms[i];
        w += 2.0 * mu / (alpha * alpha) * (stretches.array().pow(alpha).sum() - 3.0);
    }
    return w;
}

inline double energy_density(const StableNeoHookean& law, const Mat3& F) {
    const double alpha = 1.0 + 0.75 * law.mu / law.lambda;
    const auto w = [&](double I1, double J) {
        return 0.5 * law.mu * (I1 - 3.0 - std::log(I1 + 1.0)) +
               0.5 * law.lambda * (J - alpha) * (J - alpha);
    };
    return w(F.squaredNorm(), F.determinant()) - w(3.0, 1.0);
}
inline double energy_density(const Yeoh& law, const Mat3& F) {
    const double J = F.determinant(), i = std::pow(J, -2.0 / 3.0) * F.squaredNorm() - 3.0;
    return law.c1 * i + law.c2 * i * i + law.c3 * i * i * i +
           0.5 * law.bulk_modulus * (J - 1) * (J - 1);
}

inline double energy_density(const CustomLaw&, const Mat3& F) {
    return energy_density(held_by_custom_law, F);
}
inline double energy_density(const HolzapfelGasserOgden& law, const Mat3& F) {
    const double J = F.determinant(), I1 = F.squaredNorm();
    const Vec3 a0 = fibre_direction();
    const double I4 = (F * a0).squaredNorm(), kappa = law.dispersion;
    const double E = std::max(kappa * I1 + (1.0 - 3.0 * kappa) * I4 - 1.0, 0.0);
    return 0.5 * law.mu * (std::pow(J, -2.0 / 3.0) * I1 - 3.0) +
           0.5 * law.bulk_modulus * (J - 1) * (J - 1) +
           0.5 * law.k1 / law.k2 * (std::exp(law.k2 * E * E) - 1.0);
}

inline double energy_density(const Law& law, const Mat3& F) {
    return std::visit([&](const auto& one) { return energy_density(one, F); }, law);
}

}  // namespace incise::physics
