// Implicit Euler: what holds at any step, and that small steps lead where explicit ones do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "incise/base/error.h"
#include "incise/physics/solve/integrator.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "support/num_cases.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

std::vector<NamedMaterial> materials() {
    const auto all = materials_of_all_methods();
    const auto some = test::some_of(all);
    return {some.begin(), some.end()};
}

/// Held at one end, falling at the other.
BoundaryConditions cantilever(const Mesh& mesh, double damping = 0.0) {
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -5.0};
    s.damping = damping;
    s.constraints = {holding("clamp", left_end(mesh))};
    return s;
}

void run(Model& model, double dt, int num_steps) {
    ImplicitEuler integrator;
    for (int i = 0; i < num_steps; ++i) {
        integrator.step(model, i * dt, dt);
        model.compute_forces((i + 1) * dt);
    }
}

TEST(ImplicitEuler, LetsABodyFallAsTheRuleSays) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -10.0};
    Model model(mesh, table_of_one_law(soft_law), s);
    const double dt = 0.1;
    run(model, dt, 5);
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
        EXPECT_NEAR(model.velocities()[n].z(), -10.0 * 5 * dt, 1e-10);
        EXPECT_NEAR(model.positions()[n].z(),
                    mesh.rest_positions()[n].z() - 10.0 * dt * dt * (1 + 2 + 3 + 4 + 5), 1e-10);
    }
}

// A step then moves nodes by less than a strain of 1e-5, whose energy is lost in the rounding of
// the terms that laws add up.
TEST(ImplicitEuler, ConvergesForStiffTissueNearRest) {
    for (const double modulus : {1e3, 3e5, 1e6, 1e7, 1e9})
        for (const NamedLaw& named :
             {NamedLaw{"neo-Hookean", NeoHookean{0.17, 3.1}},
              NamedLaw{"Mooney-Rivlin", MooneyRivlin{0.1, 0.07, 3.1}},
              NamedLaw{"isochoric", IsochoricMooneyRivlin{0.17, 0.0, 3.3}}}) {
            SCOPED_TRACE(named.name + " of " + std::to_string(modulus));
            const Law law = std::visit(
                [&](auto scaled) -> Law {
                    if constexpr (requires { scaled.c1; }) scaled.c1 *= modulus;
                    if constexpr (requires { scaled.c2; }) scaled.c2 *= modulus;
                    if constexpr (requires { scaled.lambda; }) scaled.lambda *= modulus;
                    if constexpr (requires { scaled.bulk_modulus; }) scaled.bulk_modulus *= modulus;
                    return scaled;
                },
                named.law);
            const Mesh mesh = bar();
            for (const double damping : {0.0, 2.0}) {
                BoundaryConditions s = cantilever(mesh, damping);
                s.constraints.push_back(holding(
                    "other end",
                    VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.x() > 0.199; }))));
                Model model(mesh, table_of_one_law(law), s);
                EXPECT_NO_THROW(run(model, 0.01, 30));
            }
        }
}

TEST(ImplicitEuler, ConvergesWhileViscousTissueRelaxes) {
    for (const NamedLaw& named : test_laws())
        for (const auto& [strain, dt] : {std::pair(1e-3, 0.5), std::pair(1e-2, 0.1)}) {
            SCOPED_TRACE(named.name + ", strain " + std::to_string(strain) + ", step " +
                         std::to_string(dt));
            const Mesh mesh = bar();
            BoundaryConditions s;
            Constraint hand = holding(
                "hand", VertexSet(nodes_where(mesh, [](const Vec3& X) { return X.x() > 0.199; })));
            hand.displacement =
                TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {0.2, Vec3(0.2 * strain, 0.0, 0.0)}});
            s.constraints = {holding("clamp", left_end(mesh)), hand};
            Model model(mesh,
                        table_of_one_material(HyperElasticLinks{named.law, 0.4, {{0.5, 6.0}}}), s);
            EXPECT_NO_THROW(run(model, dt, 20));
        }
}

// Whose norm overflows: infinite is not small beside infinite.
TEST(ImplicitEuler, RefusesForcesBeyondAllNumbers) {
    const Mesh mesh = bar();
    BoundaryConditions s = cantilever(mesh);
    s.gravity = {0.0, 0.0, -1e200};
    Model model(mesh, table_of_one_law(soft_law), s);
    EXPECT_THROW(run(model, 0.1, 1), PhysicsError);
}

TEST(ImplicitEuler, KeepsMomentumOfAFreeBody) {
    for (const NamedMaterial& m : materials()) {
        SCOPED_TRACE(m.name);
        const Mesh mesh = bar(m.kind);
        Model model(mesh, m.table);
        test::Random random(1);
        set_state(model, random_state(mesh, random, 0.003, 0.5));
        const Vec3 before = model.energetics().totals().momentum;
        run(model, 0.01, 10);
        EXPECT_LE((model.energetics().totals().momentum - before).norm(), 1e-9 * before.norm());
    }
}

TEST(ImplicitEuler, IsStableFarBeyondTheExplicitBound) {
    for (const NamedMaterial& m : materials()) {
        SCOPED_TRACE(m.name);
        const Mesh mesh = bar(m.kind);
        Model model(mesh, m.table, cantilever(mesh, 5.0)), still(mesh, m.table, cantilever(mesh));
        run(model, 100.0 * model.stable_step(), 40);
        Statics().step(still, 0.0, 1.0);
        double farthest = 0.0;
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            farthest = std::max(farthest, (model.positions()[n] - still.positions()[n]).norm());
        EXPECT_LE(farthest, 1e-4 * still.max_displacement());
    }
}

TEST(ImplicitEuler, ConvergesWithFirstOrderToTheExplicitMotion) {
    for (const NamedMaterial& m : materials()) {
        SCOPED_TRACE(m.name);
        const Mesh mesh = bar(m.kind);
        const double end = 0.1;
        // Semi-implicit Euler has an error of its own; that of the mean of two runs is of higher
        // order.
        const auto explicit_end = [&](int num_steps) {
            Model model(mesh, m.table, cantilever(mesh));
            double time = 0.0;
            for (int i = 0; i < num_steps; ++i) step(model, time, end / num_steps);
            return std::vector<Vec3>(model.positions().begin(), model.positions().end());
        };
        const auto coarse = explicit_end(1000), fine = explicit_end(2000);
        std::vector<double> errors;
        for (const int num_steps : {20, 40, 80}) {
            Model model(mesh, m.table, cantilever(mesh));
            run(model, end / num_steps, num_steps);
            double largest = 0.0;
            for (std::size_t n = 0; n < coarse.size(); ++n)
                largest =
                    std::max(largest, (model.positions()[n] - (2.0 * fine[n] - coarse[n])).norm());
            errors.push_back(largest / model.max_displacement());
        }
        EXPECT_LT(errors[2], 0.05);
        EXPECT_NEAR(errors[0] / errors[1], 2.0, 0.35);
        EXPECT_NEAR(errors[1] / errors[2], 2.0, 0.2);
    }
}

TEST(ImplicitEuler, AccountsForAllEnergy) {
    for (const NamedMaterial& m : materials()) {
        SCOPED_TRACE(m.name);
        const Mesh mesh = bar(m.kind);
        BoundaryConditions s = cantilever(mesh, 3.0);
        s.constraints[0].displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {0.1, {0, 0.02, 0}}});
        Model model(mesh, m.table, s);
        double last = 0.0;
        ImplicitEuler integrator;
        for (int i = 0; i < 20; ++i) {
            integrator.step(model, 0.01 * i, 0.01);
            model.compute_forces(0.01 * (i + 1));
            const auto totals = model.energetics().totals();
            const double kept = totals.kinetic_energy + totals.elastic_energy;
            EXPECT_NEAR(model.energetics().external_work() - model.energetics().dissipated_energy(),
                        kept, 1e-9 * kept);
            EXPECT_GT(model.energetics().dissipated_energy(), last);  // the rule never gives
            last = model.energetics().dissipated_energy();
        }
    }
}

// The reaction of a strained viscous body relaxes as the Prony series says, whatever the step.
TEST(ImplicitEuler, RelaxesViscousStress) {
    const Mesh mesh = bar();
    const double tau = 0.5;
    BoundaryConditions s;
    Constraint hand = holding(
        "hand",
        VertexSet(nodes_where(mesh, [](const Vec3& X) { return std::abs(X.x() - 0.2) < 1e-9; })));
    hand.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1e-6, {0.02, 0, 0}}});
    s.constraints = {holding("clamp", left_end(mesh)), hand};
    const auto table = table_of_one_material(HyperElasticLinks{soft_law, 0.4, {{0.4, tau}}});
    Model elastic(mesh, table_of_one_law(soft_law), s), body(mesh, table, s);
    Statics().step(elastic, 0.0, 1.0);
    ImplicitEuler integrator;
    // So fast that little relaxes, then in large steps, two of which take the swing out.
    double time = 0.0;
    for (int i = 0; i < 30; ++i, time += 1e-3) integrator.step(body, time, 1e-3);
    const double begin = time;
    for (int i = 0; i < 8; ++i, time += 0.25) {
        integrator.step(body, time, 0.25);
        if (i < 2) continue;
        const double share = 0.6 + 0.4 * std::exp(-(time + 0.25 - 0.5 * begin) / tau);
        EXPECT_NEAR(body.boundary().reactions()[1].force.x(),
                    share * elastic.boundary().reactions()[1].force.x(),
                    0.01 * elastic.boundary().reactions()[1].force.x());
    }
}

TEST(ImplicitEuler, FollowsEditsAsABodyBuiltAfresh) {
    for (const NamedMaterial& m : materials()) {
        SCOPED_TRACE(m.name);
        Mesh mesh = bar(m.kind);
        Model model(mesh, m.table, cantilever(mesh));
        ImplicitEuler integrator;
        for (int i = 0; i < 3; ++i) integrator.step(model, 0.02 * i, 0.02);
        topology::MeshEdit edit(mesh);
        for (const CellId e : living_elements(mesh))
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                bool is_chosen = mesh.neighbor({e, f}).is_valid();
                for (int p = 0; p < mesh.face_size({e, f}); ++p) {
                    const Vec3& X = mesh.rest_position(mesh.face_corner({e, f}, p));
                    is_chosen &= std::abs(X.x() - 0.1) < 1e-9 && X.z() > 0.0499;
                }
                if (is_chosen) edit.open({e, f});
            }
        model.apply(model.mesh(), edit.commit());
        Model fresh(mesh, m.table, cantilever(mesh));
        set_state(fresh, state_of(model), 0.06);
        fresh.state().change().history.set_values(model.state().history().values());
        ImplicitEuler other;
        for (int i = 0; i < 2; ++i) {
            integrator.step(model, 0.06 + 0.02 * i, 0.02);
            other.step(fresh, 0.06 + 0.02 * i, 0.02);
            EXPECT_EQ(state_of(model), state_of(fresh));  // to the bit
        }
        EXPECT_GT(model.max_displacement(), 1e-4);
    }
}

}  // namespace
}  // namespace incise::physics
