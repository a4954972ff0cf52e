// The growth of the bounds on the stiffness of elements with strain, against exact tangents.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/laws/stiffening.h"

#include <gtest/gtest.h>

#include "incise/physics/elements/element_tangent.h"
#include "incise/physics/elements/spectrum.h"
#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

/// Returns the largest eigenvalue of D^-1 K, with the tangent K at x and the diagonal D of the
/// bounds at rest. The bounds at x hold if and only if they are D times at least this.
template <class Kernel, std::size_t n>
double exact_stiffening(const Kernel& kernel, const typename Kernel::Element& element,
                        const std::array<Vec3, n>& X, const std::array<Vec3, n>& x) {
    Eigen::MatrixXd K = element_tangent(kernel, element, x);
    const auto bounds = kernel.stiffness_bounds(element, X);
    Eigen::VectorXd per_root(K.rows());
    for (Eigen::Index i = 0; i < K.rows(); ++i)
        per_root[i] = 1.0 / std::sqrt(bounds[static_cast<std::size_t>(i / 3)]);
    return spectrum(per_root.asDiagonal() * K * per_root.asDiagonal()).values.maxCoeff();
}

struct Range {
    double low, high;
};
const std::vector<Range> ranges_of_stretches = {{0.98, 1.02}, {0.7, 1.5},  {0.4, 2.5},
                                                {0.05, 1.2},  {-1.2, 1.2}, {-2.2, 2.2}};

TEST(Stiffening, IsAboveThatOfExactTangents) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(1);
        double closest = 0.0;
        for (const Range& range : ranges_of_stretches)
            for (int i = 0; i < 300; ++i) {
                const Tetrahedron X = random_tetrahedron(random);
                const auto stretch = [&] { return random.uniform(range.low, range.high); };
                const Mat3 F = random_deformation(random, {stretch(), stretch(), stretch()});
                const auto element = kernel.precompute(X);
                const Tetrahedron x = deformed(X, F);
                const double exact = exact_stiffening(kernel, element, X, x);
                const double bound = std::max(kernel.stiffening(element, x), 1.0);
                ASSERT_GE(bound, exact) << "F is\n" << F;
                closest = std::max(closest, exact / bound);
            }
        EXPECT_GT(closest, 0.4);  // it is a bound of what it claims to bound
    });
}

TEST(Stiffening, OfDrawnOutTissueIsNotMuchAboveTheExactOne) {
    for_each_heml_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        if (has_fibres(kernel.law)) return;  // across their direction the bound has more room
        test::Random random(2);
        for (int i = 0; i < 100; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const double along = random.uniform(1.0, 2.2), across = 1.0 / std::sqrt(along);
            const auto element = kernel.precompute(X);
            const Tetrahedron x = deformed(X, random_deformation(random, {along, across, across}));
            const double at_rest = exact_stiffening(kernel, element, X, X);
            const double exact = exact_stiffening(kernel, element, X, x) / at_rest;
            if (exact < 5.0) {  // the steepest laws stiffen a hundredfold
                EXPECT_LE(kernel.stiffening(element, x), 5.0 * exact) << "stretch " << along;
            }
        }
    });
}

TEST(Stiffening, IsOneAtRestAndGrowsWithStrain) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(3);
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const auto element = kernel.precompute(X);
            const auto at = [&](double strain) {
                const auto stretch = [&] { return 1.0 + random.uniform(-strain, strain); };
                return kernel.stiffening(
                    element,
                    deformed(X, random_deformation(random, {stretch(), stretch(), stretch()})));
            };
            EXPECT_NEAR(at(0.0), 1.0, 1e-6);
            EXPECT_NEAR(at(1e-3), 1.0, 0.03);
        }
    });
}

TEST(Stiffening, OfHybridSpringsIsAboveThatOfExactTangents) {
    test::Random random(4);
    constexpr double infinite = std::numeric_limits<double>::infinity();
    for (const Vec3& edges : {Vec3(1, 1, 1), Vec3(1, 1.2, 0.9)})
        for (const double kappa : {0.0, 3e4, -1e3, 1e6})
            for (const double ratio : {1.0, 0.4, infinite}) {
                SCOPED_TRACE(testing::Message()
                             << edges.transpose() << ", kappa " << kappa << ", A " << ratio);
                const HybmssKernel kernel{HybridSprings{4e3, kappa, ratio}};
                std::array<Vec3, 8> X, x;
                for (std::size_t k = 0; k < 8; ++k)
                    for (int c = 0; c < 3; ++c)
                        X[k][c] = 0.5 * BoxFrame::sides[k][static_cast<std::size_t>(c)] * edges[c];
                const auto element = kernel.precompute(X);
                EXPECT_NEAR(kernel.stiffening(element, X), 1.0, 1e-6);
                for (const Range& range : ranges_of_stretches)
                    for (int i = 0; i < 100; ++i) {
                        const auto stretch = [&] { return random.uniform(range.low, range.high); };
                        const Mat3 F =
                            random_deformation(random, {stretch(), stretch(), stretch()});
                        const double uneven = 0.3 * (range.high - range.low);
                        for (std::size_t k = 0; k < 8; ++k)
                            x[k] = F * X[k] + random.vector(uneven * random.uniform(0.0, 1.0));
                        const double exact = exact_stiffening(kernel, element, X, x);
                        ASSERT_GE(1.0001 * std::max(kernel.stiffening(element, x), 1.0), exact)
                            << "F is\n"
                            << F;
                    }
            }
}

}  // namespace
}  // namespace incise::physics
