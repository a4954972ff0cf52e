// Constraints hold nodes where they say and tell the force of it; loads bring the force they state.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <numbers>

#include "incise/base/error.h"
#include "incise/physics/solve/explicit_step.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "tests/physics/test_bodies.h"

namespace incise::physics {
namespace {

using topology::CellKind;
using topology::Mesh;

constexpr double density = 1000.0;

constexpr double bar_volume = 0.2 * 0.1 * 0.1;

// Opens all inner faces in the plane across the bar at `x`; half of it, up to y = 0.05, if partly.
topology::ChangeSet open_across(Mesh& mesh, double x, bool is_partial) {
    topology::MeshEdit edit(mesh);
    for (const CellId e : living_elements(mesh))
        for (int f = 0; f < 4; ++f) {
            bool is_chosen = mesh.neighbor({e, f}).is_valid();
            for (int p = 0; p < 3; ++p) {
                const Vec3& X = mesh.rest_position(mesh.face_corner({e, f}, p));
                is_chosen &= std::abs(X.x() - x) < 1e-9 && (!is_partial || X.y() < 0.051);
            }
            if (is_chosen) edit.open({e, f});
        }
    return edit.commit();
}

TEST(Constraints, BearTheWeightInEquilibrium) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -0.5};
    s.damping = 10.0;
    s.constraints.push_back(holding("clamp", left_end(mesh)));
    Model model(mesh, table_of_one_law(soft_law, density), s);
    const double dt = 0.8 * model.stable_step(), weight = density * bar_volume * 0.5;
    const double height_energy = model.energetics().totals().gravity_energy;
    double time = 0.0;
    while (time < 10.0) step(model, time, dt);
    EXPECT_NEAR(model.boundary().reactions()[0].force.z(), weight, 1e-9 * weight);
    EXPECT_NEAR(model.boundary().reactions()[0].force.x(), 0.0, 1e-9 * weight);
    EXPECT_NEAR(model.boundary().reactions()[0].force.y(), 0.0, 1e-9 * weight);
    EXPECT_LT(model.energetics().totals().gravity_energy, height_energy);
    EXPECT_LT(model.energetics().totals().kinetic_energy,
              1e-15 * model.energetics().totals().elastic_energy);
}

TEST(Constraints, MayAgreeAtANode) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -0.5};
    s.damping = 10.0;
    s.constraints = {holding("clamp", left_end(mesh)), holding("again", left_end(mesh))};
    // Displacements of zero are none, and so are those along axes that are not prescribed.
    s.constraints[1].components = {false, true, true};
    s.constraints[1].displacement =
        TimeCurve<Vec3>({{0.0, Vec3(1.0, 0.0, 0.0)}, {1.0, Vec3(2.0, 0.0, 0.0)}});
    Model model(mesh, table_of_one_law(soft_law, density), s);
    const double dt = 0.8 * model.stable_step();
    double time = 0.0;
    for (int i = 0; i < 20; ++i) step(model, time, dt);
    EXPECT_GT(model.boundary().reactions()[0].force.z(), 0.0);
    EXPECT_EQ(model.boundary().reactions()[1].force, Vec3(0, 0, 0));  // the first has it all
}

TEST(Constraints, ConflictWhereTheirMotionDiffers) {
    const Mesh mesh = bar();
    const auto are_in_conflict = [&](auto change) {
        std::vector<Constraint> two(2, holding("hand", left_end(mesh)));
        for (Constraint& one : two) {
            one.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.0, 1.0, 2.0)}});
            one.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, 0.5}});
        }
        change(two[1]);
        return !find_conflicts(mesh, two).empty();
    };
    EXPECT_FALSE(are_in_conflict([](Constraint&) {}));
    EXPECT_TRUE(are_in_conflict([](Constraint& c) { c.point.x() = 0.1; }));
    EXPECT_TRUE(are_in_conflict([](Constraint& c) { c.axis = Vec3::UnitX(); }));
    EXPECT_TRUE(are_in_conflict([](Constraint& c) { c.angle = {}; }));
    EXPECT_TRUE(are_in_conflict([](Constraint& c) { c.displacement = {}; }));
    const auto slower = [](Constraint& c) {
        c.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {2.0, Vec3(0.0, 1.0, 2.0)}});
    };
    EXPECT_TRUE(are_in_conflict(slower));
    EXPECT_FALSE(are_in_conflict([&](Constraint& c) {
        slower(c);
        c.components = {true, false, false};  // along x both rest
    }));
    EXPECT_TRUE(are_in_conflict([](Constraint& c) { c.grip = TimeCurve<Pose>({{0.0, Pose{}}}); }));
}

TEST(Constraints, PrescribeDisplacementAndRotation) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    Constraint constraint = holding("hand", left_end(mesh));
    constraint.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.0, 0.0, 0.04)}});
    constraint.angle = TimeCurve<double>({{0.0, 0.0}, {1.0, std::numbers::pi / 2}});
    constraint.point = {0.0, 0.05, 0.05};
    constraint.axis = Vec3::UnitX();
    s.constraints.push_back(constraint);
    Model model(mesh, table_of_one_law(soft_law), s);
    double time = 0.0;
    const double dt = 1.0 / 4096.0;  // exact in binary
    ASSERT_LT(dt, model.stable_step());
    for (int i = 0; i < 4096; ++i) {
        step(model, time, dt);
        if (i != 2047 && i != 4095) continue;
        // A quarter of a turn, or half of that, about the axis through p along x; then the shift.
        const double angle = time * std::numbers::pi / 2;
        for (const VertexId n : nodes_where(mesh, [](const Vec3& x) { return x.x() == 0.0; })) {
            const Vec3 r = mesh.rest_position(n) - constraint.point;
            const Vec3 expected =
                constraint.point +
                Vec3(0.0, std::cos(angle) * r.y() - std::sin(angle) * r.z(),
                     std::sin(angle) * r.y() + std::cos(angle) * r.z() + 0.04 * time);
            EXPECT_LE((model.positions()[n.index()] - expected).norm(), 1e-15);
        }
    }
    EXPECT_EQ(time, 1.0);
}

TEST(Constraints, LeaveOtherComponentsFree) {
    const Mesh mesh = bar();
    BoundaryConditions s;
    s.gravity = {1.0, 2.0, 3.0};
    s.constraints.push_back(holding("plane",
                                    VertexSet(nodes_where(mesh, [](const Vec3&) { return true; })),
                                    {false, true, false}));
    Model model(mesh, table_of_one_law(soft_law), s);
    double time = 0.0;
    for (int i = 0; i < 10; ++i) step(model, time, 1e-3);
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
        EXPECT_EQ(model.positions()[n].y(), mesh.rest_positions()[n].y());
        EXPECT_NEAR(model.velocities()[n].x(), 1.0 * time, 1e-12);
        EXPECT_NEAR(model.velocities()[n].z(), 3.0 * time, 1e-12);
    }
    EXPECT_NEAR(model.boundary().reactions()[0].force.y(), -2.0 * 1000.0 * bar_volume, 1e-12);
    EXPECT_EQ(model.boundary().reactions()[0].force.x(), 0.0);
}

TEST(Constraints, TakeInNodesBornBetweenTheirs) {
    Mesh mesh = bar();
    BoundaryConditions s;
    Constraint constraint = holding(
        "middle",
        VertexSet(nodes_where(mesh, [](const Vec3& x) { return std::abs(x.x() - 0.1) < 1e-9; })));
    constraint.displacement = TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {1.0, Vec3(0.0, 0.01, 0.0)}});
    s.constraints.push_back(constraint);
    s.gravity = {0.0, 0.0, -9.81};
    s.damping = 5.0;
    Model model(mesh, table_of_one_law(soft_law), s);
    const auto changes = open_across(mesh, 0.1, false);
    ASSERT_EQ(changes.nodes_added.size(), 9u);
    const BodyEdit done = follow(model, changes);
    double time = 0.0;
    const double dt = 0.5 * model.stable_step();
    while (time < 1.0) step(model, time, dt);
    for (const auto& record : changes.nodes_added) {
        const Vec3 u = model.positions()[record.id.index()] - record.rest_position;
        EXPECT_LE((u - Vec3(0.0, 0.01, 0.0)).norm(), 1e-15);
    }
    // Undone and done again, it is as it was.
    take_back(mesh, model, done);
    replay(mesh, changes);
    model.apply(model.mesh(), changes);
    for (int i = 0; i < 100; ++i) step(model, time, dt);
    for (const auto& record : changes.nodes_added)
        EXPECT_LE(
            (model.positions()[record.id.index()] - record.rest_position - Vec3(0.0, 0.01, 0.0))
                .norm(),
            1e-15);
}

// A node that an edit merged away and its undoing brought back is held only if it was before.
TEST(Constraints, DoNotSpreadToRestoredNodes) {
    Mesh mesh = bar();
    const auto opened = open_across(mesh, 0.1, false);
    // Hold only one side of the open plane, the nodes that keep their ids.
    std::vector<VertexId> held;
    for (const auto& record : opened.nodes_added) held.push_back(record.sources[0].node);
    BoundaryConditions s;
    s.gravity = {0.0, 0.0, -9.81};
    s.constraints.push_back(holding("one side", VertexSet(held)));
    Model model(mesh, table_of_one_law(soft_law), s);
    topology::MeshEdit edit(mesh);
    for (const auto& pair : opened.faces_opened) edit.close(pair.a, pair.b);
    const auto closed = edit.commit();
    take_back(mesh, model, follow(model, closed));
    double time = 0.0;
    step(model, time, 1e-3);
    for (const auto& record : opened.nodes_added) {
        EXPECT_LT(model.velocities()[record.id.index()].z(), 0.0);
        EXPECT_EQ(model.velocities()[record.sources[0].node.index()].z(), 0.0);
    }
}

TEST(Constraints, RefuseToHoldANodeInTwoPlaces) {
    const Mesh mesh = bar();
    const auto table = table_of_one_law(soft_law);
    BoundaryConditions s;
    s.constraints.push_back(holding("clamp", left_end(mesh)));
    s.constraints[0].displacement = TimeCurve<Vec3>({{0.0, Vec3(0.0, 0.0, 0.01)}});
    s.constraints.push_back(
        holding("rail", VertexSet(nodes_where(mesh, [](const Vec3& x) { return x.z() == 0.0; })),
                {false, false, true}));
    try {
        Model model(mesh, table, s);
        FAIL() << "not refused";
    } catch (const InputError& error) {
        const std::string text = error.what();
        EXPECT_NE(text.find("'clamp'"), std::string::npos) << text;
        EXPECT_NE(text.find("'rail'"), std::string::npos) << text;
        EXPECT_NE(text.find("in z"), std::string::npos) << text;
        EXPECT_NE(text.find("node "), std::string::npos) << text;
    }
    s.constraints[0].components = {true, true, false};  // now they share nodes, not components
    EXPECT_NO_THROW(Model(mesh, table, s));
}

/// Momentum per time of a body that starts in `state`: the resultant of all outer forces.
Vec3 resultant(const Mesh& mesh, const Load& load, const BodyState& state, double time = 0.0) {
    BoundaryConditions s;
    s.loads.push_back(load);
    Model model(mesh, table_of_one_law(soft_law, density), s);
    set_state(model, state, time);
    const double dt = 1e-4;
    ExplicitStep().move(model, time, dt);
    return model.energetics().totals().momentum / dt;
}

TEST(Loads, OnNodesAreSharedByCopiesByMass) {
    for (const bool is_partial : {true, false}) {
        Mesh mesh = bar();
        const Vec3 force(1.0, -2.0, 0.5);
        const auto loaded =
            nodes_where(mesh, [](const Vec3& x) { return x.x() == 0.1 && x.y() == 0.0; });
        ASSERT_EQ(loaded.size(), 3u);
        BoundaryConditions s;
        s.loads.push_back({"hook", NodalLoad{VertexSet(loaded), force, {}}, {}});
        Model model(mesh, table_of_one_law(soft_law, density), s);
        const std::vector<double> masses_before(model.masses().begin(), model.masses().end());
        const auto changes = open_across(mesh, 0.1, is_partial);
        model.apply(model.mesh(), changes);
        ASSERT_FALSE(changes.nodes_added.empty());

        const double dt = 1e-4;
        model.compute_forces(0.0);
        ExplicitStep().move(model, 0.0, dt);
        EXPECT_LE((model.energetics().totals().momentum / dt - 3.0 * force).norm(), 1e-12);
        // Shared by mass, the force gives all copies the acceleration of the undivided node.
        for (const auto& record : changes.nodes_added) {
            const VertexId origin = record.sources[0].node;
            const bool is_loaded = std::find(loaded.begin(), loaded.end(), origin) != loaded.end();
            for (const VertexId n : {record.id, origin}) {
                const Vec3 expected = is_loaded ? (force / masses_before[origin.index()]).eval()
                                                : Vec3::Zero().eval();
                EXPECT_LE((model.velocities()[n.index()] / dt - expected).norm(),
                          1e-12 * force.norm() / model.masses()[n.index()]);
            }
        }
        // With all elements of a copy gone the others bear it all.
        const VertexId gone = changes.nodes_added.front().id;
        std::vector<CellId> star;
        mesh.star(gone, star);
        topology::MeshEdit edit(mesh);
        for (const CellId e : star) edit.remove(e);
        model.apply(model.mesh(), edit.commit());
        set_state(model, rest_state(mesh));
        ExplicitStep().move(model, 0.0, dt);
        EXPECT_LE((model.energetics().totals().momentum / dt - 3.0 * force).norm(), 1e-12);
    }
}

TEST(Loads, OfTractionIsForcePerRestArea) {
    const Mesh mesh = bar();
    std::vector<FaceId> top;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        bool is_top = true;
        for (int p = 0; p < 3; ++p) is_top &= mesh.rest_position(mesh.face_corner(f, p)).z() == 0.1;
        if (is_top) top.push_back(f);
    }
    const Vec3 traction(30.0, -20.0, 50.0);
    const double area = 0.2 * 0.1;
    const Load load{"wind", TractionLoad{top, traction},
                    TimeCurve<double>({{0.0, 0.0}, {1.0, 2.0}})};
    test::Random random(1);
    for (const BodyState& state : {rest_state(mesh), random_state(mesh, random, 0.005, 0.0)}) {
        EXPECT_LE((resultant(mesh, load, state, 0.25) - 0.5 * area * traction).norm(), 1e-10);
        EXPECT_LE(resultant(mesh, load, state, 0.0).norm(), 1e-10);
        EXPECT_LE((resultant(mesh, load, state, 7.0) - 2.0 * area * traction).norm(), 1e-10);
    }
}

TEST(Loads, OfPressureBalanceOnAClosedSurface) {
    for (const auto* family : test::tetrahedral_families()) {
        SCOPED_TRACE(family->name);
        const Mesh mesh = Mesh::build(family->data).mesh;
        BoundaryConditions s;
        s.loads.push_back({"gas", PressureLoad{topology::boundary_faces(mesh), 700.0}, {}});
        Model model(mesh, table_of_one_law(soft_law), s);
        test::Random random(2);
        BodyState state = random_state(mesh, random, 0.01, 0.0);
        set_state(model, state);
        // The forces themselves, from one step: m v / dt, about the positions they act at.
        const double dt = 1e-6;
        ExplicitStep().move(model, 0.0, dt);
        Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
        double scale = 0.0, moment_scale = 0.0;
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n) {
            const Vec3 force = model.masses()[n] / dt * model.velocities()[n];
            sum += force;
            moment += state.positions[n].cross(force);
            scale += force.norm();
            moment_scale += state.positions[n].norm() * force.norm();
        }
        EXPECT_LE(sum.norm(), 1e-13 * scale);
        EXPECT_LE(moment.norm(), 1e-13 * moment_scale);
    }
}

TEST(Loads, OfPressureFollowTheSurface) {
    const Mesh mesh = bar();
    std::vector<FaceId> right;
    for (const FaceId f : topology::boundary_faces(mesh)) {
        bool is_right = true;
        for (int p = 0; p < 3; ++p)
            is_right &= std::abs(mesh.rest_position(mesh.face_corner(f, p)).x() - 0.2) < 1e-9;
        if (is_right) right.push_back(f);
    }
    const Load load{"gas", PressureLoad{right, 500.0}, {}};
    test::Random random(3);
    const Mat3 F = random_deformation(random, {1.3, 0.8, 1.1});
    BodyState state = rest_state(mesh);
    for (Vec3& x : state.positions) x = F * x;
    // Nanson: n da = J F^-T N dA; the pressure pushes inwards.
    const Vec3 area = F.determinant() * F.inverse().transpose() * Vec3(0.1 * 0.1, 0.0, 0.0);
    EXPECT_LE((resultant(mesh, load, state) + 500.0 * area).norm(), 1e-10);
}

TEST(Loads, OfBodyForceAreForcePerRestVolume) {
    Mesh mesh = bar();
    const Vec3 force(100.0, 200.0, -300.0);
    std::vector<CellId> elements = living_elements(mesh);
    elements.resize(elements.size() / 3);
    const double volume = bar_volume / 3.0;  // all elements of a Kuhn box have the same volume
    const Load load{"field", BodyLoad{elements, force}, {}};
    test::Random random(4);
    const BodyState state = random_state(mesh, random, 0.005, 0.0);
    EXPECT_LE((resultant(mesh, load, state) - volume * force).norm(), 1e-11);
    // Elements that are gone carry nothing.
    topology::MeshEdit edit(mesh);
    edit.remove(elements.front());
    edit.commit();
    const double left = volume * (1.0 - 1.0 / static_cast<double>(elements.size()));
    EXPECT_LE((resultant(mesh, load, rest_state(mesh)) - left * force).norm(), 1e-11);
}

TEST(TimeCurve, IsLinearBetweenKeysAndConstantOutside) {
    const TimeCurve<double> curve({{1.0, 10.0}, {2.0, 20.0}, {4.0, 0.0}});
    EXPECT_EQ(curve.at(-5.0), 10.0);
    EXPECT_EQ(curve.at(1.0), 10.0);
    EXPECT_EQ(curve.at(1.25), 12.5);
    EXPECT_EQ(curve.at(2.0), 20.0);
    EXPECT_EQ(curve.at(3.0), 10.0);
    EXPECT_EQ(curve.at(4.0), 0.0);
    EXPECT_EQ(curve.at(9.0), 0.0);
}

}  // namespace
}  // namespace incise::physics
