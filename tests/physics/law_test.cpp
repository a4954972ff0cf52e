// Laws against their definitions: rest moduli, energies in F, the extension below J0.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/law.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>

#include "physics/test_materials.h"

namespace incise::physics {
namespace {

TEST(Laws, AreAllTested) {
    const auto laws = test_laws();
    for (std::size_t i = 0; i < std::variant_size_v<Law>; ++i)
        EXPECT_TRUE(std::any_of(laws.begin(), laws.end(),
                                [&](const NamedLaw& named) { return named.law.index() == i; }))
            << "no row of test_laws() has alternative " << i << " of Law";
}

// Energy densities as textbooks write them, in terms of the deformation gradient.
double energy_density(const SaintVenantKirchhoff& law, const Mat3& F) {
    const Mat3 E = 0.5 * (F.transpose() * F - Mat3::Identity());
    return 0.5 * law.lambda * E.trace() * E.trace() + law.mu * (E * E).trace();
}
double energy_density(const NeoHookean& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    return law.c1 * (F.squaredNorm() - 3.0) - 2.0 * law.c1 * ln + 0.5 * law.lambda * ln * ln;
}
double energy_density(const MooneyRivlin& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    const Mat3 C = F.transpose() * F;
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
    return law.c1 * (I1 - 3.0) + law.c2 * (I2 - 3.0) - (2.0 * law.c1 + 4.0 * law.c2) * ln +
           0.5 * law.lambda * ln * ln;
}

double energy_density(const CiarletNeoHookean& law, const Mat3& F) {
    const double J = F.determinant();
    return 0.5 * law.mu * (F.squaredNorm() - 3.0) - (law.mu + 0.5 * law.lambda) * std::log(J) +
           0.25 * law.lambda * (J * J - 1.0);
}
double energy_density(const FungDemiray& law, const Mat3& F) {
    const double ln = std::log(F.determinant());
    return 0.5 * law.mu / law.gamma * (std::exp(law.gamma * (F.squaredNorm() - 3.0)) - 1.0) -
           law.mu * ln + 0.5 * law.lambda * ln * ln;
}
double energy_density(const IsochoricMooneyRivlin& law, const Mat3& F) {
    const double J = F.determinant();
    const Mat3 C = std::pow(J, -2.0 / 3.0) * F.transpose() * F;
    const double I1 = C.trace(), I2 = 0.5 * (I1 * I1 - (C * C).trace());
    return law.c1 * (I1 - 3.0) + law.c2 * (I2 - 3.0) + 0.5 * law.bulk_modulus * (J - 1) * (J - 1);
}
double energy_density(const IsochoricFungDemiray& law, const Mat3& F) {
    const double J = F.determinant();
    const double I1 = std::pow(J, -2.0 / 3.0) * F.squaredNorm();
    return 0.5 * law.mu / law.gamma * (std::exp(law.gamma * (I1 - 3.0)) - 1.0) +
           0.5 * law.bulk_modulus * (J - 1) * (J - 1);
}
double energy_density(const Ogden& law, const Mat3& F) {
    const double J = F.determinant();
    const Eigen::SelfAdjointEigenSolver<Mat3> modes(F.transpose() * F);
    const Vec3 stretches = modes.eigenvalues().cwiseSqrt() / std::cbrt(J);
    double w = 0.5 * law.bulk_modulus * (J - 1) * (J - 1);
    for (std::size_t i = 0; i < law.num_terms; ++i) {
        const auto [mu, alpha] = law.terms[i];
        w += 2.0 * mu / (alpha * alpha) * (stretches.array().pow(alpha).sum() - 3.0);
    }
    return w;
}

TEST(Laws, GiveByLinksTheEnergyOfTheDeformationGradient) {
    for_each_heml_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(3);
        for (int i = 0; i < 100; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const Mat3 F = random_deformation(
                random,
                {random.uniform(0.8, 2.0), random.uniform(0.8, 2.0), random.uniform(0.8, 2.0)});
            const auto element = kernel.precompute(X);
            const double w = energy_density(kernel.law, F);
            const double modulus = kernel.law.rest_lambda() + kernel.law.rest_mu();
            EXPECT_NEAR(kernel.energy(element, deformed(X, F)) / element.volume, w,
                        1e-12 * (std::abs(w) + modulus));
        }
    });
}

// Cauchy stress of one element: minus the virial of its forces over its volume.
template <class Kernel>
Mat3 cauchy_stress(const Kernel& kernel, const Tetrahedron& X, const Mat3& F) {
    const auto element = kernel.precompute(X);
    const Tetrahedron x = deformed(X, F), f = kernel.forces(element, x);
    Mat3 sum = Mat3::Zero();
    for (std::size_t k = 0; k < 4; ++k) sum -= f[k] * x[k].transpose();
    return sum / (element.volume * F.determinant());
}

TEST(Laws, HaveTheRestModuliThatTheyState) {
    for_each_heml_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(4);
        const double lambda = kernel.law.rest_lambda(), mu = kernel.law.rest_mu();
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            Mat3 D = random_deformation(random, random.vector(1.0));
            D = (0.5 * (D + D.transpose())).eval();
            const auto stress = [&](double s) {
                return cauchy_stress(kernel, X, Mat3::Identity() + s * D);
            };
            // Five-point difference: truncation h^4 and round-off eps/h both near 1e-12.
            const double h = 1e-3;
            const Mat3 tangent =
                (8.0 * (stress(h) - stress(-h)) - (stress(2 * h) - stress(-2 * h))) / (12.0 * h);
            const Mat3 hooke = lambda * D.trace() * Mat3::Identity() + 2.0 * mu * D;
            EXPECT_LE((tangent - hooke).norm(), 1e-9 * (lambda + 2.0 * mu));
        }
    });
}

TEST(Laws, ExtendTheVolumeTermByItsTangentBelowTheThreshold) {
    for (const double J0 : {0.2, 0.4, 0.8}) {
        const auto check = [&](const auto& law, double lambda, double p) {
            // HEML 2015, section 4.4, corrected: w_J = slope J + intercept below J0.
            const double ln = std::log(J0);
            const double slope = (lambda - lambda * ln + p) / (J0 * J0);
            const double intercept = (2.0 * lambda * ln - lambda - 2.0 * p) / J0;
            const auto w_J = [&](double J) { return law.response({0, 0, J}, J0).w_J; };
            const auto w = [&](double J) { return law.response({0, 0, J}, J0).w; };
            for (const double J : {J0, 0.5 * J0, 0.0, -0.3, -2.0})
                EXPECT_NEAR(w_J(J), slope * J + intercept, 1e-13 * (slope + std::abs(intercept)));
            // From above the same value, and the same slope.
            const double h = 1e-4 * J0, above = std::nextafter(J0, 1.0);
            EXPECT_NEAR(w(above), w(J0), 1e-13 * std::abs(w(J0)));
            EXPECT_NEAR(w_J(above), w_J(J0), 1e-13 * std::abs(w_J(J0)));
            const double slope_above =
                (-25.0 * w_J(above) + 48.0 * w_J(above + h) - 36.0 * w_J(above + 2.0 * h) +
                 16.0 * w_J(above + 3.0 * h) - 3.0 * w_J(above + 4.0 * h)) /
                (12.0 * h);
            EXPECT_NEAR(slope_above, slope, 1e-9 * slope);
            EXPECT_GT(slope, 0.0);  // the extension stabilises
        };
        for (const NamedLaw& named : test_laws()) {
            SCOPED_TRACE(named.name);
            if (const auto* law = std::get_if<NeoHookean>(&named.law))
                check(*law, law->lambda, 2.0 * law->c1);
            if (const auto* law = std::get_if<MooneyRivlin>(&named.law))
                check(*law, law->lambda, 2.0 * law->c1 + 4.0 * law->c2);
        }
    }
}

TEST(Laws, OgdenFindsTheStretchesAlsoWhereTheyAreAlike) {
    test::Random random(9);
    for (const double spread : {1.0, 1e-2, 1e-5, 1e-9, 0.0})
        for (int i = 0; i < 50; ++i) {
            const Vec3 stretches = Vec3::Constant(random.uniform(0.3, 2.0)) +
                                   spread * Vec3(random.uniform(0, 1), random.uniform(0, 1), 0);
            std::array<double, 3> expected;
            for (int k = 0; k < 3; ++k)
                expected[static_cast<std::size_t>(k)] = stretches[k] * stretches[k];
            std::sort(expected.begin(), expected.end());
            const Vec3 twice_E = stretches.cwiseAbs2() - Vec3::Ones();
            const LinkStrain s{twice_E.sum(), twice_E.squaredNorm(), stretches.prod()};
            const auto found = squared_principal_stretches(s);
            // Roots that nearly coincide are known to a third of the digits.
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 3e-5);
        }
}

// One power of two is the isochoric neo-Hookean law.
TEST(Laws, OgdenWithThePowerTwoIsNeoHookean) {
    const Ogden ogden{{{{3000.0, 2.0}}}, 1, 9000.0};
    const IsochoricMooneyRivlin neo_hookean{1500.0, 0.0, 9000.0};
    test::Random random(10);
    for (int i = 0; i < 200; ++i) {
        const double spread = i % 2 == 0 ? 0.8 : 1e-8;
        const Tetrahedron X = random_tetrahedron(random);
        const Mat3 F = random_deformation(random, Vec3::Constant(1.1) + random.vector(spread / 2));
        const HemlKernel<Ogden> a{ogden, 0.1};
        const HemlKernel<IsochoricMooneyRivlin> b{neo_hookean, 0.1};
        const auto element = a.precompute(X);
        const Tetrahedron f = a.forces(element, deformed(X, F)),
                          g = b.forces(element, deformed(X, F));
        for (std::size_t k = 0; k < 4; ++k) EXPECT_LE((f[k] - g[k]).norm(), 1e-9 * 9000.0);
    }
}

// Energy and derivatives agree at the level of the law, also beyond what elements can show at once.
TEST(Laws, DifferentiateTheirEnergy) {
    test::Random random(5);
    for (const NamedLaw& named : test_laws())
        std::visit(
            [&](const auto& law) {
                SCOPED_TRACE(named.name);
                // Of stretches that are real only; ElementForces.AreMinusTheGradientOfTheEnergy.
                if (std::holds_alternative<Ogden>(named.law)) return;
                for (int i = 0; i < 50; ++i) {
                    const LinkStrain s{random.uniform(-1, 3), random.uniform(0, 4),
                                       random.uniform(-1.5, 3)};
                    const LawResponse r = law.response(s, 0.4);
                    const double h = 1e-4;
                    if (std::abs(s.J - 0.4) < 3 * h) continue;
                    const auto difference = [&](double LinkStrain::*x) {
                        const auto w = [&](double d) {
                            LinkStrain shifted = s;
                            shifted.*x += d;
                            return law.response(shifted, 0.4).w;
                        };
                        return (8.0 * (w(h) - w(-h)) - (w(2 * h) - w(-2 * h))) / (12.0 * h);
                    };
                    const double scale =
                        1e-9 * (law.rest_lambda() + law.rest_mu() + std::abs(r.w_J));
                    EXPECT_NEAR(r.w_a, difference(&LinkStrain::a), scale);
                    EXPECT_NEAR(r.w_b, difference(&LinkStrain::b), scale);
                    EXPECT_NEAR(r.w_J, difference(&LinkStrain::J), scale);
                }
            },
            named.law);
}

}  // namespace
}  // namespace incise::physics
