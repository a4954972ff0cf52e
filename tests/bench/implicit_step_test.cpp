// The implicit step of bench/comparators against differences of the program's own forces, which
// know nothing of its matrix, and against what backward Euler keeps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "bench/comparators/implicit_step.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/physics/test_bodies.h"

namespace incise::bench {
namespace {

using physics::BodyState;
using physics::Model;
using topology::Mesh;

constexpr physics::SaintVenantKirchhoff tissue{5769.0, 3846.0};
constexpr double density = 1000.0;  // kg/m3
constexpr double dt = 0.01;         // s, many times the bound of an explicit step

struct Body {
    Mesh mesh = Mesh::build(test::jittered_cube(2, 0.2, 1)).mesh;
    std::vector<Nodes> tetrahedra = tetrahedra_of(mesh);
    Model model{mesh, physics::table_of_one_law(tissue, density)};
    BodyState state;

    explicit Body(std::uint64_t seed) {
        test::Random random(seed);
        state = physics::random_state(mesh, random, 0.02, 0.5);
    }
    std::span<const Vec3> forces_at(const std::vector<Vec3>& positions) {
        physics::set_state(model, {positions, state.velocities});
        return model.elastic_forces();
    }
};

/// M/dt^2 - df/dx by differences over five points: exact up to rounding, as the forces of Saint
/// Venant-Kirchhoff tissue are cubic in the positions.
Eigen::MatrixXd matrix_by_differences(Body& body) {
    const auto num_nodes = body.mesh.node_capacity();
    const auto n = static_cast<Eigen::Index>(3 * num_nodes);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    const double h = 0.05;  // m
    for (std::size_t k = 0; k < num_nodes; ++k)
        for (int c = 0; c < 3; ++c) {
            Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
            for (const auto& [steps, weight] :
                 {std::pair{-2.0, 1.0}, {-1.0, -8.0}, {1.0, 8.0}, {2.0, -1.0}}) {
                std::vector<Vec3> moved = body.state.positions;
                moved[k][c] += steps * h;
                const auto f = body.forces_at(moved);
                for (std::size_t i = 0; i < num_nodes; ++i)
                    slope.segment<3>(static_cast<Eigen::Index>(3 * i)) +=
                        weight / (12.0 * h) * f[i];
            }
            const auto column = static_cast<Eigen::Index>(3 * k) + c;
            A.col(column) = -slope;
            A(column, column) += body.model.masses()[k] / (dt * dt);
        }
    return A;
}

TEST(ImplicitStep, HasTheTangentOfTheForcesOfHeml) {
    for (const std::uint64_t seed : {1, 2, 3}) {
        Body body(seed);
        ImplicitStep implicit(tissue, density, body.tetrahedra, body.mesh.rest_positions());
        implicit.assemble(dt, body.state.positions, body.state.velocities);
        const Eigen::MatrixXd expected = matrix_by_differences(body);
        const Eigen::MatrixXd lower = implicit.matrix();
        EXPECT_EQ(lower, Eigen::MatrixXd(lower.triangularView<Eigen::Lower>()));
        const Eigen::MatrixXd A = lower.selfadjointView<Eigen::Lower>();
        EXPECT_LE((A - expected).cwiseAbs().maxCoeff(), 1e-11 * expected.cwiseAbs().maxCoeff());
    }
}

TEST(ImplicitStep, GoesWhereADenseSolutionSays) {
    Body body(4);
    const Eigen::MatrixXd A = matrix_by_differences(body);
    const auto forces = body.forces_at(body.state.positions);
    const std::vector<std::uint32_t> held{3, 8};
    Eigen::MatrixXd reduced = A;
    Eigen::VectorXd right(A.rows());
    for (std::size_t n = 0; n < forces.size(); ++n)
        right.segment<3>(static_cast<Eigen::Index>(3 * n)) =
            forces[n] + body.model.masses()[n] / dt * body.state.velocities[n];
    for (const std::uint32_t n : held) {
        reduced.middleRows<3>(3 * n).setZero();
        reduced.middleCols<3>(3 * n).setZero();
        reduced.block<3, 3>(3 * n, 3 * n).setIdentity();
        right.segment<3>(3 * n).setZero();
    }
    const Eigen::VectorXd d = reduced.partialPivLu().solve(right);

    ImplicitStep implicit(tissue, density, body.tetrahedra, body.mesh.rest_positions(), held);
    BodyState after = body.state;
    ASSERT_TRUE(implicit.step(dt, after.positions, after.velocities));
    const double scale = d.cwiseAbs().maxCoeff();
    for (std::size_t n = 0; n < forces.size(); ++n) {
        const Vec3 move = d.segment<3>(static_cast<Eigen::Index>(3 * n));
        EXPECT_LE((after.positions[n] - body.state.positions[n] - move).norm(), 1e-11 * scale);
        if (n == 3 || n == 8)
            EXPECT_EQ(after.positions[n], body.state.positions[n]);
        else
            EXPECT_LE((after.velocities[n] - move / dt).norm(), 1e-11 * scale / dt);
    }
}

TEST(ImplicitStep, KeepsTheMomentumOfAFreeBody) {
    Body body(5);
    ImplicitStep implicit(tissue, density, body.tetrahedra, body.mesh.rest_positions());
    const auto momentum = [&] {
        Vec3 sum = Vec3::Zero();
        for (std::size_t n = 0; n < body.state.velocities.size(); ++n)
            sum += body.model.masses()[n] * body.state.velocities[n];
        return sum;
    };
    const Vec3 before = momentum();
    for (int i = 0; i < 20; ++i)
        ASSERT_TRUE(implicit.step(dt, body.state.positions, body.state.velocities));
    EXPECT_LE((momentum() - before).norm(), 1e-11 * before.norm());
}

TEST(ImplicitStep, ReportsAMatrixThatIsNotPositive) {
    Body body(6);
    for (Vec3& x : body.state.positions) x *= 0.3;  // far beyond where the law turns soft
    ImplicitStep implicit(tissue, density, body.tetrahedra, body.mesh.rest_positions());
    BodyState after = body.state;
    EXPECT_FALSE(implicit.step(10.0, after.positions, after.velocities));
    EXPECT_EQ(after.positions, body.state.positions);
}

}  // namespace
}  // namespace incise::bench
