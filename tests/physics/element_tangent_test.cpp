// Tangents of elements against differences of their forces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/element_tangent.h"

#include <gtest/gtest.h>

#include "incise/physics/elements/spectrum.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

/// By a difference of fourth order with steps of h, m.
template <std::size_t n, class Forces>
ElementTangent<n> difference_of_forces(std::array<Vec3, n> x, double h, Forces forces) {
    ElementTangent<n> K;
    for (std::size_t k = 0; k < n; ++k)
        for (int c = 0; c < 3; ++c) {
            const double at = x[k][c];
            const auto shifted = [&](double d) {
                x[k][c] = at + d;
                const auto f = forces(x);
                Eigen::Matrix<double, 3 * n, 1> all;
                for (std::size_t m = 0; m < n; ++m)
                    all.template segment<3>(static_cast<Eigen::Index>(3 * m)) = f[m];
                return all;
            };
            K.col(static_cast<Eigen::Index>(3 * k) + c) =
                -(8.0 * (shifted(h) - shifted(-h)) - (shifted(2 * h) - shifted(-2 * h))) /
                (12.0 * h);
            x[k][c] = at;
        }
    return K;
}

template <class Kernel, std::size_t n>
void check(const Kernel& kernel, const typename Kernel::Element& element,
           const std::array<Vec3, n>& x, double h, double tolerance) {
    const auto K = element_tangent(kernel, element, x);
    const auto expected =
        difference_of_forces(x, h, [&](const auto& y) { return kernel.forces(element, y); });
    EXPECT_LE((K - K.transpose()).norm(), 1e-13 * K.norm());
    EXPECT_LE((K - expected).norm(), tolerance * K.norm()) << K << "\nfor\n" << expected;
}

// Away from the threshold of inversion, where the volume term's slope has a kink. Strongly
// nonlinear laws leave differences fewer digits.
bool is_smooth(double J) { return std::abs(J - 0.4) > 0.02; }

TEST(ElementTangent, DifferentiatesForcesOfStrainedTetrahedra) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(1);
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const Mat3 F = random_deformation(
                random,
                {random.uniform(0.75, 1.7), random.uniform(0.75, 1.7), random.uniform(0.75, 1.7)});
            const auto element = kernel.precompute(X);
            const Tetrahedron x = deformed(X, F);
            if (is_smooth(kernel.volume_ratio(element, x))) check(kernel, element, x, 3e-4, 1e-8);
        }
    });
}

TEST(ElementTangent, DifferentiatesForcesOfFlatAndInvertedTetrahedra) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(2);
        for (const double last : {0.02, -0.3, -0.9}) {
            const Tetrahedron X = random_tetrahedron(random);
            const Mat3 F = random_deformation(
                random, {random.uniform(0.8, 1.2), random.uniform(0.8, 1.2), last});
            const auto element = kernel.precompute(X);
            check(kernel, element, deformed(X, F), 1e-4, 1e-7);
        }
    });
}

// Ogden's stretches found twice or three times, and nearly so; other laws have no such trouble.
TEST(ElementTangent, DifferentiatesForcesWhereStretchesAreAlike) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(3);
        for (const double spread : {0.0, 1e-9, 1e-6, 1e-3, 3e-2})
            for (const double third : {0.0, 0.3}) {
                const Tetrahedron X = random_tetrahedron(random);
                const double s = random.uniform(0.85, 1.2);
                const Mat3 F = random_deformation(random, {s, s + spread, s + third - spread});
                check(kernel, kernel.precompute(X), deformed(X, F), 1e-3, 1e-7);
            }
    });
}

TEST(ElementTangent, DifferentiatesForcesOfHexahedra) {
    test::Random random(4);
    for (const double kappa : {0.0, 3e4, -1e3})
        for (const double ratio : {1.0, 0.4}) {
            const HybmssKernel kernel{HybridSprings{4e3, kappa, ratio}};
            for (const double last : {1.2, 0.9, -0.5}) {
                std::array<Vec3, 8> X, x;
                const Mat3 F = random_deformation(
                    random, {random.uniform(0.8, 1.3), random.uniform(0.8, 1.3), last});
                for (std::size_t k = 0; k < 8; ++k) {
                    for (int c = 0; c < 3; ++c)
                        X[k][c] = BoxFrame::sides[k][static_cast<std::size_t>(c)] > 0 ? 1.0 : 0.0;
                    x[k] = F * X[k] + random.vector(0.1);
                }
                check(kernel, kernel.precompute(X), x, 1e-3, 1e-9);
            }
        }
}

TEST(ElementTangent, OfAStressIsThatOfItsForces) {
    test::Random random(5);
    const Tetrahedron X = random_tetrahedron(random), x = random_tetrahedron(random);
    const LinkElement element = link_element(X);
    Mat3 S;
    for (int c = 0; c < 3; ++c) S.col(c) = random.vector(100.0);
    S = (S + S.transpose()).eval();
    const auto K = tangent_of_stress(S, element);
    const auto expected = difference_of_forces(
        x, 0.1, [&](const auto& y) { return forces_of_stress(S, element, y); });
    EXPECT_LE((K - expected).norm(), 1e-12 * K.norm());
}

TEST(ElementTangent, PositivePartKeepsWhatIsPositive) {
    test::Random random(6);
    const MassSpringKernel kernel{1e4};
    const Tetrahedron X = random_tetrahedron(random);
    const auto at_rest = element_tangent(kernel, kernel.precompute(X), X);
    EXPECT_LE((positive_part(at_rest) - at_rest).norm(), 1e-12 * at_rest.norm());
    Tetrahedron x = X;
    for (Vec3& p : x) p *= 0.5;  // springs pressed together want to turn aside
    const auto pressed = element_tangent(kernel, kernel.precompute(X), x);
    EXPECT_LT(spectrum(pressed).values[0], -0.1 * pressed.norm());
    EXPECT_GE(spectrum(positive_part(pressed)).values[0], -1e-12 * pressed.norm());
}

}  // namespace
}  // namespace incise::physics
