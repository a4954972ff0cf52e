// What every kernel of one element has to keep, HEML with each law and springs alike.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/physics/test_materials.h"

namespace incise::physics {
namespace {

struct NamedDeformation {
    std::string name;
    Mat3 F;
};

// J0 is that of for_each_kernel, 0.4.
std::vector<NamedDeformation> random_deformations(test::Random& random) {
    const auto stretch = [&] { return random.uniform(0.5, 2.0); };
    const auto with_volume_ratio = [&](double J) -> Mat3 {
        const Mat3 F = random_deformation(random, {stretch(), stretch(), stretch()});
        return std::cbrt(J / F.determinant()) * F;
    };
    Mat3 small = Mat3::Identity();
    for (int c = 0; c < 3; ++c) small.col(c) += random.vector(0.02);
    return {
        {"small", small},
        {"large", random_deformation(random, {stretch(), stretch(), stretch()})},
        {"flat", random_deformation(random, {0.0, stretch(), stretch()})},
        {"turned inside out", random_deformation(random, {-stretch(), stretch(), stretch()})},
        {"turned in all directions",
         random_deformation(random, {-stretch(), -stretch(), -stretch()})},
        {"just below J0", with_volume_ratio(0.4 * (1.0 - 1e-3))},
        {"just above J0", with_volume_ratio(0.4 * (1.0 + 1e-3))},
    };
}

double largest(const Tetrahedron& f) {
    double size = 0.0;
    for (const Vec3& v : f) size = std::max(size, v.norm());
    return size;
}

/// Calls visit(kernel, element, rest positions, positions) for each kernel and many states.
template <class Visit>
void for_each_state(std::uint64_t seed, Visit visit) {
    for_each_kernel([&](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(seed);
        for (int i = 0; i < 40; ++i) {
            SCOPED_TRACE(i);
            const Tetrahedron X = random_tetrahedron(random, random.uniform(0.5, 2.0));
            const auto element = kernel.precompute(X);
            for (const auto& [state, F] : random_deformations(random)) {
                SCOPED_TRACE(state);
                visit(kernel, element, X, deformed(X, F), random);
            }
        }
    });
}

TEST(ElementForces, AreMinusTheGradientOfTheEnergy) {
    for_each_state(1, [](const auto& kernel, const auto& element, const Tetrahedron&,
                         const Tetrahedron& x, test::Random&) {
        const Tetrahedron f = kernel.forces(element, x);
        // Five-point differences; the step keeps their points on one side of J0, where the third
        // derivative of the energy jumps.
        const double h = 1e-4 * std::cbrt(element.volume);
        for (std::size_t k = 0; k < 4; ++k)
            for (int c = 0; c < 3; ++c) {
                const auto energy = [&](double d) {
                    Tetrahedron moved = x;
                    moved[k][c] += d;
                    return kernel.energy(element, moved);
                };
                const double slope =
                    (8.0 * (energy(h) - energy(-h)) - (energy(2 * h) - energy(-2 * h))) /
                    (12.0 * h);
                EXPECT_NEAR(f[k][c], -slope, 1e-8 * largest(f));
            }
    });
}

TEST(ElementForces, HaveNoResultantAndNoMoment) {
    for_each_state(2, [](const auto& kernel, const auto& element, const Tetrahedron&,
                         const Tetrahedron& x, test::Random&) {
        const Tetrahedron f = kernel.forces(element, x);
        Vec3 resultant = Vec3::Zero(), moment = Vec3::Zero();
        double force_scale = 0.0, moment_scale = 0.0;
        for (std::size_t k = 0; k < 4; ++k) {
            resultant += f[k];
            moment += x[k].cross(f[k]);
            force_scale += f[k].norm();
            moment_scale += x[k].norm() * f[k].norm();
        }
        EXPECT_LE(resultant.norm(), 1e-13 * force_scale);
        EXPECT_LE(moment.norm(), 1e-13 * moment_scale);
    });
}

TEST(ElementForces, TurnWithTheBody) {
    for_each_state(3, [](const auto& kernel, const auto& element, const Tetrahedron&,
                         const Tetrahedron& x, test::Random& random) {
        const Mat3 R = random_rotation(random);
        const Tetrahedron turned = deformed(x, R);
        const Tetrahedron f = kernel.forces(element, x), g = kernel.forces(element, turned);
        for (std::size_t k = 0; k < 4; ++k) EXPECT_LE((g[k] - R * f[k]).norm(), 1e-12 * largest(f));
        // Round-off of the terms of the energy, which near rest is a small difference of them.
        const double w = kernel.energy(element, x);
        EXPECT_NEAR(kernel.energy(element, turned), w,
                    1e-12 * (std::abs(w) + largest(f) * std::cbrt(element.volume)));
    });
}

TEST(ElementForces, AndEnergyAreContinuousAtTheInversionThreshold) {
    for_each_heml_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(6);
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const auto element = kernel.precompute(X);
            const Mat3 F = random_deformation(random, {0.5, 1.0, 0.8});  // J = J0
            const double distance = 1e-10;
            const Tetrahedron below = deformed(X, (1.0 - distance) * F);
            const Tetrahedron above = deformed(X, (1.0 + distance) * F);
            const double w = kernel.energy(element, above);
            EXPECT_NEAR(kernel.energy(element, below), w, 100.0 * distance * std::abs(w));
            const Tetrahedron f = kernel.forces(element, below), g = kernel.forces(element, above);
            for (std::size_t k = 0; k < 4; ++k)
                EXPECT_LE((f[k] - g[k]).norm(), 100.0 * distance * largest(g));
        }
    });
}

// Differences of edge lengths vanish to the bit at rest. Where volume terms balance the others,
// round-off of one volume ratio is left.
TEST(ElementForces, VanishAtRest) {
    for_each_kernel([](const std::string& name, const auto& kernel) {
        SCOPED_TRACE(name);
        test::Random random(7);
        for (int i = 0; i < 100; ++i) {
            const double size = random.uniform(1e-3, 1e3);
            const Tetrahedron X = random_tetrahedron(random, size);
            const auto element = kernel.precompute(X);
            const double force = largest(kernel.forces(element, X));
            if constexpr (requires { kernel.law; }) {
                const double modulus = rest_lambda(kernel.law) + 2.0 * rest_mu(kernel.law);
                EXPECT_LE(force, 1e-14 * modulus * size * size);
            }
            if (name == "springs" || name.starts_with("Saint Venant")) {
                EXPECT_EQ(force, 0.0);
            }
            EXPECT_EQ(kernel.energy(element, X), 0.0);
            EXPECT_EQ(kernel.volume_ratio(element, X), 1.0);
        }
    });
}

// An element pressed flat feels a force that raises it again, to the side where it came from.
TEST(ElementForces, OpenAFlatElement) {
    for_each_heml_kernel([](const std::string& name, const auto& kernel) {
        if (name.starts_with("Saint Venant")) return;  // does not resist inversion
        SCOPED_TRACE(name);
        test::Random random(8);
        for (int i = 0; i < 20; ++i) {
            const Tetrahedron X = random_tetrahedron(random);
            const auto element = kernel.precompute(X);
            Tetrahedron x = X;
            const Vec3 normal = (X[1] - X[0]).cross(X[2] - X[0]).normalized();
            for (const double height : {0.0, -0.1}) {
                x[3] = X[3] - (normal.dot(X[3] - X[0]) - height) * normal;
                EXPECT_GT(kernel.forces(element, x)[3].dot(normal), 0.0);
            }
        }
    });
}

}  // namespace
}  // namespace incise::physics
