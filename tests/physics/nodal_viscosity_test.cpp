// The nodal recursion of a Prony series: the paper's formula to the letter, its order, and its
// limits, which are facts to be known: it does not turn with the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "incise/physics/elements/nodal_viscous_kernel.h"
#include "incise/physics/elements/viscous_kernel.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "tests/physics/test_bodies.h"
#include "tests/physics/viscous_work.h"

namespace incise::physics {
namespace {

using topology::Mesh;

HyperElasticLinks links(const Series& series, PronyRule rule = PronyRule::nodal) {
    return {soft_law, 0.4, series, rule};
}

/// Calls visit(name, kernel) for HEML with each law and two terms.
template <class Visit>
void for_each_nodal_kernel(Visit visit) {
    for_each_heml_kernel([&](const std::string& name, const auto& elastic) {
        visit(name, WithFibre(NodalViscousKernel(elastic, two_terms)));
    });
}

Memory no_memory() { return Memory(NodalViscousKernel::history_size(two_terms.size()), 0.0); }

// Eq. (20) on the forces of the nodes themselves, beside a moving body.
TEST(NodalViscosity, IsTheRecursionOfThePaper) {
    const Mesh mesh = Mesh::build(test::jittered_cube(2, 0.1, 3)).mesh;
    Model model(mesh, table_of_one_material(links(two_terms)));
    Model elastic(mesh, table_of_one_law(soft_law));
    test::Random random(41);
    set_state(model, random_state(mesh, random, 0.03, 0.5));
    std::vector<std::vector<Vec3>> gamma(two_terms.size(),
                                         std::vector<Vec3>(mesh.node_capacity(), Vec3::Zero()));
    double time = 0.0;
    for (int i = 0; i < 50; ++i) {
        const double dt = (i % 3 == 0 ? 0.3 : 0.1) * model.stable_step();
        ExplicitStep().move(model, time, dt);
        time += dt;
        model.compute_forces(time);
        set_state(elastic, state_of(model));
        double largest = 0.0;
        for (const Vec3& f : elastic.elastic_forces()) largest = std::max(largest, f.norm());
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
            const Vec3 f = elastic.elastic_forces()[n];
            Vec3 expected = f;
            for (std::size_t k = 0; k < two_terms.size(); ++k) {
                const auto [alpha, tau] = two_terms[k];
                gamma[k][n] = dt * alpha / (dt + tau) * f + tau / (dt + tau) * gamma[k][n];
                expected -= gamma[k][n];
            }
            EXPECT_LE((model.elastic_forces()[n] - expected).norm(), 1e-12 * largest);
        }
    }
}

// A strain that comes at once and is held: the exact fading, to first order in the step.
TEST(NodalViscosity, RelaxesToFirstOrder) {
    const Mesh mesh = Mesh::build(test::jittered_cube(1, 0.1, 3)).mesh;
    test::Random random(42);
    const BodyState state = random_state(mesh, random, 0.05, 0.0);
    const auto error = [&](int steps) {
        Model model(mesh, table_of_one_material(links(two_terms), 1e30));  // too heavy to move
        Model elastic(mesh, table_of_one_law(soft_law, 1e30));
        set_state(elastic, state);
        set_state(model, state);
        EXPECT_TRUE(std::ranges::equal(model.elastic_forces(), elastic.elastic_forces()));
        double largest = 0.0;
        for (int i = 1; i <= steps; ++i) {
            ExplicitStep().move(model, 0.0, 1.0 / steps);
            model.compute_forces(0.0);
            double share = 0.3;
            for (const auto& [alpha, tau] : two_terms)
                share += alpha * std::exp(-static_cast<double>(i) / steps / tau);
            for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
                const Vec3 f = elastic.elastic_forces()[n];
                largest =
                    std::max(largest, (model.elastic_forces()[n] - share * f).norm() / f.norm());
            }
        }
        // In the end the long-time moduli, of which the elastic energy is.
        for (int i = 0; i < 400; ++i) ExplicitStep().move(model, 0.0, 1.0);
        model.compute_forces(0.0);
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            EXPECT_LE((model.elastic_forces()[n] - 0.3 * elastic.elastic_forces()[n]).norm(),
                      1e-12 * elastic.elastic_forces()[n].norm());
        EXPECT_NEAR(model.energetics().totals().elastic_energy,
                    0.3 * elastic.energetics().totals().elastic_energy,
                    1e-12 * elastic.energetics().totals().elastic_energy);
        EXPECT_EQ(model.stable_step(), elastic.stable_step());
        return largest;
    };
    const double coarse = error(50), middle = error(100), fine = error(200);
    EXPECT_NEAR(coarse / middle, 2.0, 0.15);
    EXPECT_NEAR(middle / fine, 2.0, 0.1);
    EXPECT_LT(fine, 0.005);
}

// Creep under a constant force of one term: strain = load/modulus (1/g - (1/g - 1) exp(-g t/tau)),
// g = 1 - alpha. Quasi-static: each step the strain is found at which the element bears the load.
TEST(NodalViscosity, CreepsToFirstOrder) {
    const double alpha = 0.6, tau = 0.5, g = 1.0 - alpha, strain = 1e-7;
    const auto error = [&](int steps) {
        NodalViscousKernel kernel({SaintVenantKirchhoff{0.0, 1.0}, 0.4}, {{alpha, tau}});
        const Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
        const auto e = kernel.precompute(X);
        const auto at = [&](double s) { return deformed(X, Vec3(1 + s, 1, 1).asDiagonal()); };
        Memory memory(kernel.history_size(1), 0.0);
        double now = strain, largest = 0.0;
        const double load = kernel.forces(e, at(now), memory)[1].x();
        kernel.begin_step(1.0 / steps);
        for (int i = 1; i <= steps; ++i) {
            const auto force_after = [&](double next) {
                Memory tried = memory;
                kernel.advance(e, at(now), at(next), tried);
                return kernel.forces(e, at(next), tried)[1].x();
            };
            double low = now, high = 3.0 * strain / g;
            for (int k = 0; k < 60; ++k) {
                const double middle = 0.5 * (low + high);
                (force_after(middle) > load ? low : high) = middle;  // the force is negative
            }
            kernel.advance(e, at(now), at(low), memory);
            now = low;
            const double t = static_cast<double>(i) / steps;
            const double expected = strain * (1.0 / g - (1.0 / g - 1.0) * std::exp(-g * t / tau));
            largest = std::max(largest, std::abs(now / expected - 1.0));
        }
        return largest;
    };
    const double coarse = error(50), middle = error(100), fine = error(200);
    EXPECT_NEAR(coarse / middle, 2.0, 0.1);
    EXPECT_NEAR(middle / fine, 2.0, 0.1);
    EXPECT_LT(fine, 0.005);
}

// The limit for which the other rule is the default. Half of the stress of a stretched element has
// all but faded when the element makes a quarter turn.
TEST(NodalViscosity, DoesNotTurnWithTheBody) {
    const Series half{{0.5, 1.0}};
    const Tetrahedron X{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
    const Mat3 quarter = Eigen::AngleAxisd(0.5 * std::numbers::pi, Vec3::UnitZ()).matrix();
    Mat3 shear = Mat3::Identity();
    shear(0, 1) = 0.3;
    const Tetrahedron x = deformed(X, shear), turned = deformed(x, quarter);
    struct Measure {
        double size, moment;  // over those of the elastic forces; force times length
    };
    const auto measure = [&](auto kernel) {
        const auto e = kernel.precompute(X);
        Memory memory(kernel.history_size(1), 0.0);
        kernel.begin_step(0.0);
        kernel.advance(e, X, x, memory);
        const auto sudden = kernel.forces(e, x, memory);
        kernel.begin_step(0.001);
        for (int i = 0; i < 5000; ++i) kernel.advance(e, x, x, memory);
        kernel.begin_step(0.0);
        kernel.advance(e, x, turned, memory);
        const auto f = kernel.forces(e, turned, memory);
        double square = 0.0, square_of_sudden = 0.0;
        Vec3 moment = Vec3::Zero(), sum = Vec3::Zero();
        for (std::size_t k = 0; k < 4; ++k) {
            square += f[k].squaredNorm();
            square_of_sudden += sudden[k].squaredNorm();
            moment += turned[k].cross(f[k]);
            sum += f[k];
        }
        EXPECT_LE(sum.norm(), 1e-13 * std::sqrt(square));
        return Measure{std::sqrt(square / square_of_sudden),
                       moment.norm() / std::sqrt(square_of_sudden)};
    };
    const HemlKernel elastic{soft_law, 0.4};
    const Measure stress = measure(ViscousKernel(elastic, half));
    EXPECT_NEAR(stress.size, 0.5 + 0.5 * std::exp(-5.0), 1e-12);
    EXPECT_LE(stress.moment, 1e-13);
    const Measure nodal = measure(NodalViscousKernel(elastic, half));
    // With a held state the recursion is geometric.
    const double remembered = 0.5 * (1.0 - std::pow(1.0 / 1.001, 5000));
    EXPECT_NEAR(remembered, 0.5 - 0.5 * std::exp(-5.0), 1e-4);
    const auto e = HemlKernel::Element(elastic.precompute(X));
    const Tetrahedron sudden = elastic.forces(e, x);
    double square = 0.0, square_of_sudden = 0.0;
    Vec3 moment = Vec3::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
        const Vec3 f = quarter * sudden[k] - remembered * sudden[k];
        square += f.squaredNorm();
        square_of_sudden += sudden[k].squaredNorm();
        moment += turned[k].cross(f);
    }
    EXPECT_NEAR(nodal.size, std::sqrt(square / square_of_sudden), 1e-12);
    EXPECT_NEAR(nodal.moment, moment.norm() / std::sqrt(square_of_sudden), 1e-12);
    // As docs/theory.md states it: more than twice the force, and a moment out of nothing.
    EXPECT_NEAR(nodal.size, 1.117, 1e-3);
    EXPECT_NEAR(nodal.moment, 0.074, 1e-3);
}

// What advance() returns is the work done on the element less the growth of its energy, also
// through flat states.
TEST(NodalViscosity, DissipatesTheWorkMissingFromItsEnergy) {
    for_each_nodal_kernel([&](const std::string& name, auto kernel) {
        SCOPED_TRACE(name);
        const auto error = [&](int num_steps) {
            return missing_work(kernel, no_memory(), num_steps);
        };
        const double coarse = error(200), fine = error(400);
        EXPECT_LE(coarse, 1e-3);
        EXPECT_LE(fine, 0.5 * coarse + 1e-12);
    });
}

}  // namespace
}  // namespace incise::physics
