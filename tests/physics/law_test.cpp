// Laws against their definitions: rest moduli, energies in F, the extension below J0.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/law.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/test_materials.h"
#include "tests/physics/textbook_energies.h"

namespace incise::physics {
namespace {

TEST(Laws, AreAllTested) {
    const auto laws = test_laws();
    for (std::size_t i = 0; i < std::variant_size_v<Law>; ++i)
        EXPECT_TRUE(std::any_of(laws.begin(), laws.end(),
                                [&](const NamedLaw& named) { return named.law.index() == i; }))
            << "no row of test_laws() has alternative " << i << " of Law";
}

TEST(Laws, GiveTheSameEnergyByLinksAndGradient) {
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
            const double modulus = rest_lambda(kernel.law) + rest_mu(kernel.law);
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
        if (has_fibres(kernel.law)) return;  // Fibres.AddTheirModulusAtRestInTensionOnly
        SCOPED_TRACE(name);
        test::Random random(4);
        const double lambda = rest_lambda(kernel.law), mu = rest_mu(kernel.law);
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

TEST(Laws, ExtendVolumeTermsByTangentsBelowTheThreshold) {
    for (const double J0 : {0.2, 0.4, 0.8}) {
        const auto check = [&](const auto& law, double lambda, double p) {
            // HEML 2015, section 4.4, corrected: w_J = slope J + intercept below J0.
            const double ln = std::log(J0);
            const double slope = (lambda - lambda * ln + p) / (J0 * J0);
            const double intercept = (2.0 * lambda * ln - lambda - 2.0 * p) / J0;
            const auto w_J = [&](double J) {
                return law.response(LinkStrain{0.0, 0.0, J}, J0).w_J;
            };
            const auto w = [&](double J) { return law.response(LinkStrain{0.0, 0.0, J}, J0).w; };
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

TEST(Laws, OgdenFindsStretchesAlsoWhereTheyAreAlike) {
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
            auto found = SquaredStretches<double>(s, 1e-100, 0.01).all();
            std::sort(found.begin(), found.end());
            // Roots that nearly coincide are known to a third of the digits.
            for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], expected[k], 3e-5);
        }
}

// In principal axes, stress over stretch is h'(c) J^-q and what its change by J adds. Where
// stretches of which one is below the floor of powers nearly coincide, rounding of the invariants
// is felt by its root: there they are a hundredth apart.
TEST(Laws, OgdenHasTheStressOfEachStretch) {
    test::Random random(13);
    constexpr double J0 = 0.4, floor = J0 * J0, mu = 1000.0, K = 7000.0;
    const auto check = [&](double alpha, const Vec3& stretches) {
        const double p = 0.5 * alpha, q = alpha / 3.0, factor = 2.0 * mu / (alpha * alpha);
        const auto g =
            extended([=](double J) { return power_of_volume(J, q); }, stretches.prod(), J0);
        const Vec3 c = stretches.cwiseAbs2();
        double sum = 0.0;
        Vec3 slopes;
        for (int k = 0; k < 3; ++k) {
            const double at = std::max(c[k], floor), d = c[k] - at;
            const double first = p * std::pow(at, p - 1.0);
            sum += std::pow(at, p) + first * d * (1.0 + 0.5 * d / floor);
            slopes[k] = first * (1.0 + d / floor);
        }
        const Vec3 twice_E = c - Vec3::Ones();
        const LinkStrain s{twice_E.sum(), twice_E.squaredNorm(), stretches.prod()};
        const Ogden law{{{{mu, alpha}}}, 1, K};
        const auto r = law.response(s, J0);
        const double w_J = factor * g.first * sum + K * (s.J - 1.0);
        const Vec3 expected = factor * g.value * slopes + 0.5 * s.J * w_J * c.cwiseInverse(),
                   found = r.w_a * Vec3::Ones() + 2.0 * r.w_b * twice_E +
                           0.5 * s.J * r.w_J * c.cwiseInverse();
        EXPECT_LE((found - expected).cwiseProduct(stretches).norm(),
                  1e-11 * (mu + expected.cwiseProduct(stretches).norm()))
            << "alpha " << alpha << ", stretches " << stretches.transpose();
    };
    for (const double alpha : {1.3, 2.0, 4.0, -3.0, -19.0, 40.0})
        for (int i = 0; i < 50; ++i) {
            for (const double spread : {0.3, 1e-2, 1e-4, 1e-6, 1e-8, 0.0})
                check(alpha, Vec3::Constant(random.uniform(0.5, 1.5)) +
                                 spread * Vec3(random.uniform(0, 1), random.uniform(0, 1), 0));
            check(alpha, Vec3(J0 + 0.005, J0 - 0.005, random.uniform(0.8, 1.5)));
            check(alpha, Vec3(J0 + random.uniform(0.2, 0.5), random.uniform(0.0, 0.2),
                              random.uniform(-1.5, -0.8)));
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
        const HemlKernel a{ogden, 0.1};
        const HemlKernel b{neo_hookean, 0.1};
        const auto element = a.precompute(X);
        const Tetrahedron f = a.forces(element, deformed(X, F)),
                          g = b.forces(element, deformed(X, F));
        for (std::size_t k = 0; k < 4; ++k) EXPECT_LE((f[k] - g[k]).norm(), 1e-9 * 9000.0);
    }
}

double energy_density_by_links(const Law& law, const Mat3& F) {
    const Mat3 twice_E = F.transpose() * F - Mat3::Identity();
    const LinkStrain s{twice_E.trace(), twice_E.squaredNorm(), F.determinant()};
    return std::visit([&](const auto& one) { return one.response(s, 0.4).w; }, law);
}

// From a point energy falls all the way to rest, along with any deformation that does not invert;
// from a line it falls as the element opens. The tangent extension has a minimum at the point.
TEST(Laws, StableNeoHookeanHasNoMinimumWhenCollapsed) {
    test::Random random(12);
    for (const NamedLaw& named : test_laws()) {
        if (!std::holds_alternative<StableNeoHookean>(named.law)) continue;
        SCOPED_TRACE(named.name);
        const auto w = [&](const Mat3& F) { return energy_density_by_links(named.law, F); };
        const Mat3 one = Mat3::Identity();
        for (int i = 1; i <= 100; ++i) EXPECT_LT(w(0.01 * i * one), w(0.01 * (i - 1) * one));
        for (int i = 0; i < 20; ++i) {
            const Mat3 F = random_deformation(
                random, {random.uniform(0.3, 1.5), random.uniform(0.3, 1.5), 1.0});
            EXPECT_LT(w(1e-3 * F), w(Mat3::Zero()));
            for (const double along : {0.01, 0.3, 1.0, 3.0, 100.0}) {
                const Mat3 Q = random_rotation(random);
                const auto opened = [&](double s) {
                    return w(Q * Vec3(along, s, s).asDiagonal() * Q.transpose());
                };
                EXPECT_LT(opened(1e-2 / (1.0 + along)), opened(0.0)) << along;
            }
        }
    }
    const Law extended = NeoHookean{1.0, 3.0};
    EXPECT_NEAR(energy_density_by_links(extended, Mat3::Zero()), 8.715, 1e-3);
    EXPECT_NEAR(energy_density_by_links(extended, 0.05 * Mat3::Identity()), 8.719, 1e-3);
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
                                       random.uniform(-1.5, 3), random.uniform(-1, 3)};
                    const LawResponse r = law.response(s, 0.4);
                    const double h = 1e-4;
                    if (std::abs(s.J - 0.4) < 3 * h) continue;
                    const auto difference = [&](double LinkStrain<double>::*x) {
                        const auto w = [&](double d) {
                            LinkStrain<double> shifted = s;
                            shifted.*x += d;
                            return law.response(shifted, 0.4).w;
                        };
                        return (8.0 * (w(h) - w(-h)) - (w(2 * h) - w(-2 * h))) / (12.0 * h);
                    };
                    const double scale =
                        1e-9 * (law.rest_lambda() + law.rest_mu() + std::abs(r.w_J));
                    EXPECT_NEAR(r.w_a, difference(&LinkStrain<double>::a), scale);
                    EXPECT_NEAR(r.w_b, difference(&LinkStrain<double>::b), scale);
                    EXPECT_NEAR(r.w_J, difference(&LinkStrain<double>::J), scale);
                    EXPECT_NEAR(r.w_f, difference(&LinkStrain<double>::f), scale);
                }
            },
            named.law);
}

// The matrix of second derivatives by a, b, J and f, from a response with derivatives.
Eigen::Matrix4d second_derivatives(const LawResponse<Dual>& r) {
    Eigen::Matrix4d w;
    w << r.w_a.gradient, r.w_b.gradient, r.w_J.gradient, r.w_f.gradient;
    return w;
}

TEST(Laws, DifferentiateTheirForces) {
    test::Random random(6);
    for (const NamedLaw& named : test_laws())
        std::visit(
            [&](const auto& law) {
                SCOPED_TRACE(named.name);
                if (std::holds_alternative<Ogden>(named.law)) return;  // below
                for (int i = 0; i < 50; ++i) {
                    const LinkStrain s{random.uniform(-1, 3), random.uniform(0, 4),
                                       random.uniform(-1.5, 3), random.uniform(-0.5, 1)};
                    const double h = 1e-4;
                    if (std::abs(s.J - 0.4) < 3 * h || std::abs(s.f) < 3 * h) continue;
                    const LawResponse r = law.response(s, 0.4);
                    const LawResponse with = law.response(with_derivatives(s), 0.4);
                    const Eigen::Vector4d first(r.w_a, r.w_b, r.w_J, r.w_f);
                    EXPECT_EQ(with.w.value, r.w);
                    EXPECT_EQ(Eigen::Vector4d(with.w_a.value, with.w_b.value, with.w_J.value,
                                              with.w_f.value),
                              first);
                    const Eigen::Matrix4d w = second_derivatives(with);
                    const double scale = law.rest_lambda() + law.rest_mu() + w.norm();
                    EXPECT_LE((with.w.gradient - first).norm(), 1e-13 * (scale + first.norm()));
                    EXPECT_LE((w - w.transpose()).norm(), 1e-13 * scale);
                    int place = 0;
                    for (double LinkStrain<double>::*x :
                         {&LinkStrain<double>::a, &LinkStrain<double>::b, &LinkStrain<double>::J,
                          &LinkStrain<double>::f}) {
                        const auto at = [&](double d) {
                            LinkStrain<double> shifted = s;
                            shifted.*x += d;
                            const LawResponse q = law.response(shifted, 0.4);
                            return Eigen::Vector4d(q.w_a, q.w_b, q.w_J, q.w_f);
                        };
                        const Eigen::Vector4d difference =
                            (8.0 * (at(h) - at(-h)) - (at(2 * h) - at(-2 * h))) / (12.0 * h);
                        EXPECT_LE((w.col(place++) - difference).norm(), 1e-9 * scale);
                    }
                }
            },
            named.law);
}

// Sums of even powers of stretches are polynomials of the invariants, but for powers of J.
struct PowerFour {  // l1^4 + l2^4 + l3^4 = I1^2 - 2 I2
    static constexpr double alpha = 4.0;
    static Dual by_I1(const Dual& I1, const Dual&, const Dual&) { return 2.0 * I1; }
    static Dual by_I2(const Dual&, const Dual&, const Dual&) { return -2.0; }
    static Dual by_I3(const Dual&, const Dual&, const Dual&) { return 0.0; }
    static Dual sum(const Dual& I1, const Dual& I2, const Dual&) { return I1 * I1 - 2.0 * I2; }
};
struct PowerMinusFour {  // (I2^2 - 2 I1 I3) / I3^2
    static constexpr double alpha = -4.0;
    static Dual by_I1(const Dual&, const Dual&, const Dual& I3) { return -2.0 / I3; }
    static Dual by_I2(const Dual&, const Dual& I2, const Dual& I3) { return 2.0 * I2 / (I3 * I3); }
    static Dual by_I3(const Dual& I1, const Dual& I2, const Dual& I3) {
        return 2.0 * (I1 - I2 * I2 / I3) / (I3 * I3);
    }
    static Dual sum(const Dual& I1, const Dual& I2, const Dual& I3) {
        return (I2 * I2 / I3 - 2.0 * I1) / I3;
    }
};

TEST(Laws, OgdenDifferentiatesForcesWhereStretchesAreAlike) {
    test::Random random(12);
    const auto check = [&](auto powers, const Vec3& stretches) {
        constexpr double alpha = decltype(powers)::alpha, mu = 1000.0, K = 7000.0, J0 = 0.1;
        const Ogden law{{{{mu, alpha}}}, 1, K};
        const Vec3 twice_E = stretches.cwiseAbs2() - Vec3::Ones();
        const LinkStrain s =
            with_derivatives({twice_E.sum(), twice_E.squaredNorm(), stretches.prod()});
        const Dual I1 = 3.0 + s.a, I2 = 3.0 + 2.0 * s.a + 0.5 * (s.a * s.a - s.b), I3 = s.J * s.J;
        const Dual factor = 2.0 * mu / (alpha * alpha) * pow(s.J, -alpha / 3.0);
        const Dual by_I2 = factor * powers.by_I2(I1, I2, I3);
        const Dual w_a = factor * powers.by_I1(I1, I2, I3) + by_I2 * (2.0 + s.a);
        const Dual w_b = -0.5 * by_I2;
        const Dual w_J = factor * (2.0 * s.J * powers.by_I3(I1, I2, I3) -
                                   alpha / 3.0 / s.J * powers.sum(I1, I2, I3)) +
                         K * (s.J - 1.0);
        const Eigen::Matrix4d expected = second_derivatives({{}, w_a, w_b, w_J}),
                              found = second_derivatives(law.response(s, J0));
        EXPECT_LE((found - expected).norm(), 1e-9 * expected.norm())
            << "at the stretches " << stretches.transpose() << "\n"
            << found << "\nfor\n"
            << expected;
        const Dual w = law.response(s, J0).w;
        EXPECT_LE((w.gradient - Eigen::Vector4d(w_a.value, w_b.value, w_J.value, 0)).norm(),
                  1e-9 * (w.gradient.norm() + mu));
    };
    for (const double spread : {1.0, 0.3, 1e-1, 1e-2, 1e-3, 1e-5, 1e-9, 0.0})
        for (int i = 0; i < 50; ++i) {
            Vec3 stretches = Vec3::Constant(random.uniform(0.5, 2.0)) +
                             spread * Vec3(random.uniform(0, 1), random.uniform(0, 1), 0);
            check(PowerFour{}, stretches);
            check(PowerMinusFour{}, stretches);
            stretches[2] *= random.uniform(0.5, 2.0);  // two alike, or none
            check(PowerFour{}, stretches);
            check(PowerMinusFour{}, stretches);
        }
}

}  // namespace
}  // namespace incise::physics
