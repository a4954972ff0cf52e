// Terms of forces that somebody adds, and the stages of an explicit step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "incise/physics/solve/integrator.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::ChangeSet;
using topology::Mesh;

/// Ties each node to where it was at rest by a spring.
class Tethers final : public ForceTerm {
  public:
    explicit Tethers(double stiffness) : stiffness_(stiffness) {}

    void add_forces(const BodyView& body, NodeRange range, std::span<const Vec3> positions,
                    double /*time*/, std::span<Vec3> forces) const override {
        for (std::size_t n = range.begin; n < range.end; ++n)
            if (body.masses[n] > 0.0)
                forces[n] += stiffness_ * (body.mesh.rest_position(VertexId(n)) - positions[n]);
    }
    void visit_tangents(std::span<const Vec3> positions, double /*time*/,
                        TangentSink& sink) const override {
        const Mat3 tangent = stiffness_ * Mat3::Identity();
        for (std::uint32_t n = 0; n < positions.size(); ++n)
            sink.add(std::span(&n, 1), {tangent.data(), 9});
    }
    double stiffness_bound(NodeId) const override { return stiffness_; }
    void apply(const BodyView&, const BodyEdit& edit) override {
        num_touched += edit.touched_nodes.size();
    }

    std::size_t num_touched = 0;

  private:
    double stiffness_;
};

BoundaryConditions held_moved_and_damped(const Mesh& mesh) {
    BoundaryConditions s;
    s.gravity = {0.5, 0.0, -9.81};
    s.damping = 3.0;
    Constraint left = holding("left", left_end(mesh), {true, false, true});
    left.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.0, 0.0, 0.3)}});
    s.constraints.push_back(left);
    return s;
}

void expect_same_motion(const Model& one, const Model& other) {
    EXPECT_EQ(state_of(one), state_of(other));
    EXPECT_TRUE(
        std::ranges::equal(one.state().history().values(), other.state().history().values()));
    EXPECT_NEAR(one.energetics().external_work(), other.energetics().external_work(),
                1e-13 * (1.0 + std::abs(one.energetics().external_work())));
    EXPECT_NEAR(one.energetics().dissipated_energy(), other.energetics().dissipated_energy(),
                1e-13 * (1.0 + one.energetics().dissipated_energy()));
    for (std::size_t i = 0; i < one.boundary().reactions().size(); ++i) {
        EXPECT_TRUE(one.boundary().reactions()[i].force.isApprox(
            other.boundary().reactions()[i].force, 1e-12));
        EXPECT_TRUE(one.boundary().reactions()[i].torque.isApprox(
            other.boundary().reactions()[i].torque, 1e-12));
    }
}

struct NoProjection final : VelocityProjection {
    void project(Model&, ExplicitStep&, double, double) override {}
};

TEST(Stages, WithoutProjectionAreTheFusedStep) {
    for (const NamedMaterial& material : materials_of_all_methods()) {
        SCOPED_TRACE(material.name);
        const Mesh mesh = bar(material.kind);
        Model fused(mesh, material.table, held_moved_and_damped(mesh));
        Model staged(mesh, material.table, held_moved_and_damped(mesh));
        SemiImplicitEuler one_pass, stages;
        NoProjection none;
        stages.add_projection(none);
        const double dt = 0.5 * fused.stable_step();
        for (int i = 0; i < 50; ++i) {
            one_pass.step(fused, i * dt, dt);
            stages.step(staged, i * dt, dt);
            for (Model* model : {&fused, &staged}) model->compute_forces((i + 1) * dt);
        }
        expect_same_motion(fused, staged);
    }
}

TEST(VariableSteps, LetTheForceActOverTheMeanOfTwoSteps) {
    const Mesh mesh = bar();
    const Constraint held = holding("left", left_end(mesh), {true, false, true});
    Model model(
        mesh, table_of_one_law(soft_law),
        {.gravity = Vec3(1.0, 2.0, -9.0), .damping = 0.0, .constraints = {held}, .loads = {}});
    SemiImplicitEuler integrator;
    const double bound = 0.5 * model.structure().rest_stable_step();
    double time = 0.0, last = 0.0;
    for (const double dt : {0.5 * bound, bound, bound, 0.3 * bound, 0.31 * bound}) {
        const std::vector<Vec3> before(model.velocities().begin(), model.velocities().end());
        const std::vector<Vec3> elastic(model.elastic_forces().begin(),
                                        model.elastic_forces().end()),
            outer(model.boundary().outer_forces().begin(), model.boundary().outer_forces().end());
        integrator.step(model, time, dt);
        const double acting = last == 0.0 ? dt : 0.5 * (last + dt);
        for (const VertexId n : mesh.nodes()) {
            Vec3 expected = before[n.index()] + acting / model.masses()[n.index()] *
                                                    (elastic[n.index()] + outer[n.index()]);
            if (model.boundary().constraints().of_node(n.index()))
                expected.x() = expected.z() = 0.0;
            EXPECT_LE((model.velocities()[n.index()] - expected).norm(), 1e-12 * expected.norm());
        }
        time += dt;
        last = dt;
        model.compute_forces(time);
    }
}

/// Gives the same impulse to all nodes of a set.
struct Push final : VelocityProjection {
    VertexId node;
    Vec3 impulse;
    Push(VertexId of_node, const Vec3& of_impulse) : node(of_node), impulse(of_impulse) {}
    void project(Model& model, ExplicitStep& step, double, double) override {
        std::vector<Vec3> impulses(model.positions().size(), Vec3::Zero());
        impulses[node.index()] = impulse;
        step.give_impulses(model, impulses);
    }
};

TEST(Stages, ImpulsesChangeMomentumAndWork) {
    const Mesh mesh = bar();
    const Vec3 impulse(1e-3, -2e-3, 5e-4);
    Model model(mesh, table_of_one_law(soft_law));
    SemiImplicitEuler integrator;
    Push push(VertexId(3), impulse);
    integrator.add_projection(push);
    const double dt = 0.1 * model.stable_step();
    const Totals before = model.energetics().totals();
    integrator.step(model, 0.0, dt);
    EXPECT_TRUE((model.energetics().totals().momentum - before.momentum).isApprox(impulse, 1e-12));
    // From rest: the work is the kinetic energy that it leaves.
    EXPECT_NEAR(model.energetics().external_work(), model.energetics().totals().kinetic_energy,
                1e-12 * model.energetics().external_work());
}

TEST(Stages, ConstraintsBearTheImpulsesOnTheirNodes) {
    const Mesh mesh = bar();
    const Vec3 impulse(1e-3, -2e-3, 5e-4);
    BoundaryConditions held;
    held.constraints.push_back(holding("left", left_end(mesh)));
    const VertexId node = held.constraints[0].nodes.members()[0].node;
    Model model(mesh, table_of_one_law(soft_law), held);
    SemiImplicitEuler integrator;
    Push push(node, impulse);
    integrator.add_projection(push);
    const double dt = 0.1 * model.stable_step();
    integrator.step(model, 0.0, dt);
    Model alone(mesh, table_of_one_law(soft_law), held);
    ExplicitStep().move(alone, 0.0, dt);
    EXPECT_EQ(state_of(model), state_of(alone));
    EXPECT_TRUE(model.boundary().reactions()[0].force.isApprox(-impulse / dt, 1e-12));
    EXPECT_NEAR(model.energetics().external_work(), 0.0, 1e-20);
}

TEST(ForceTerms, BearTheWeightWithConstraintsInStatics) {
    for (const NamedMaterial& material : materials_of_all_methods()) {
        SCOPED_TRACE(material.name);
        const Mesh mesh = bar(material.kind);
        BoundaryConditions weight;
        weight.gravity = {0.0, 0.0, -9.81};
        weight.constraints.push_back(holding("left", left_end(mesh)));
        Model model(mesh, material.table, weight);
        constexpr double stiffness = 50.0;
        model.boundary().add_force_term(std::make_unique<Tethers>(stiffness));
        Statics statics;
        statics.step(model, 0.0, 0.0);
        Vec3 sum = Vec3::Zero();
        for (const VertexId n : mesh.nodes())
            sum += stiffness * (mesh.rest_position(n) - model.positions()[n.index()]);
        EXPECT_GT(sum.z(), 0.1 * 9.81 * model.energetics().totals().mass);
        EXPECT_NEAR(sum.z() + model.boundary().reactions()[0].force.z(),
                    9.81 * model.energetics().totals().mass,
                    1e-7 * model.energetics().totals().mass);
    }
}

TEST(ForceTerms, KeepTheEnergyBalanceOfExplicitSteps) {
    const Mesh mesh = bar();
    Model model(mesh, table_of_one_law(soft_law));
    const double step_without = model.stable_step();
    constexpr double stiffness = 5.0;
    model.boundary().add_force_term(std::make_unique<Tethers>(stiffness));
    EXPECT_LT(model.stable_step(), step_without);
    test::Random random(7);
    set_state(model, random_state(mesh, random, 0.0, 0.1));
    const auto energy_of_tethers = [&] {
        double energy = 0.0;
        for (const VertexId n : mesh.nodes())
            energy += 0.5 * stiffness *
                      (mesh.rest_position(n) - model.positions()[n.index()]).squaredNorm();
        return energy;
    };
    const double before = energy_of_tethers();
    const double dt = 0.02 * model.stable_step();
    double time = 0.0;
    for (int i = 0; i < 400; ++i) step(model, time, dt);
    EXPECT_NEAR(model.energetics().external_work(), before - energy_of_tethers(), 0.01 * before);
}

TEST(ForceTerms, FollowEdits) {
    Mesh mesh = bar();
    Model model(mesh, table_of_one_law(soft_law));
    auto owned = std::make_unique<Tethers>(10.0);
    const Tethers& tethers = *owned;
    model.boundary().add_force_term(std::move(owned));
    topology::MeshEdit edit(mesh);
    edit.remove(living_elements(mesh).front());
    model.apply(mesh, edit.commit());
    EXPECT_GT(tethers.num_touched, 0u);
    Model afresh(mesh, table_of_one_law(soft_law));
    afresh.boundary().add_force_term(std::make_unique<Tethers>(10.0));
    EXPECT_EQ(model.stable_step(), afresh.stable_step());
}

TEST(StateVersion, GrowsWithEachChangeOfTheState) {
    const Mesh mesh = bar();
    Model model(mesh, table_of_one_law(soft_law));
    const auto grows = [&](auto change) {
        const std::uint64_t before = model.state().version();
        change();
        return model.state().version() > before;
    };
    const double dt = 0.1 * model.stable_step();
    ExplicitStep step;
    EXPECT_TRUE(grows([&] { step.move(model, 0.0, dt); }));
    EXPECT_TRUE(grows([&] { set_state(model, rest_state(mesh)); }));
    EXPECT_TRUE(grows([&] { step.kick(model, 0.0, dt); }));
    EXPECT_TRUE(grows([&] { step.drift(model, 0.0, dt); }));
    EXPECT_FALSE(grows([&] { model.compute_forces(dt); }));
    EXPECT_FALSE(grows([&] { model.energetics().totals(); }));
}

}  // namespace
}  // namespace incise::physics
