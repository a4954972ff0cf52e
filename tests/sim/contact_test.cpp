// Contact in a world: faces of cuts, and probes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/num_cases.h"
#include "support/surfaces.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

/// The cube without loads.
WorldDef cube_at_rest(double friction = 0.0) {
    WorldDef def = soft_body();
    def.gravity.setZero();
    def.contact.friction = friction;
    return def;
}

TEST(Contact, OfAFreshCutExertsNoForce) {
    World world(cube_at_rest(0.3));
    StepInputs inputs = cut_along(world, {0.05, 0.05, 0.049}, {0.3, 0.1, 1.0});
    for (int i = 0; i < 1000; ++i, inputs.clear()) {
        const StepReport& report = world.step(0.8 * world.stable_step(), inputs);
        ASSERT_EQ(report.contact.num_points, 0u);
    }
    EXPECT_EQ(world.report().contact.dissipation, 0.0);
    for (const VertexId n : world.mesh().nodes())
        EXPECT_LE((world.positions()[n.index()] - world.mesh().rest_position(n)).norm(),
                  1e-12 * size);
}

TEST(Contact, ChangesNoBitUntilSomethingTouches) {
    WorldDef without = soft_body();
    without.contact.enabled = false;
    World a = held(World(soft_body())), b = held(World(std::move(without)));
    for (int i = 0; i < 100; ++i) {
        a.step(0.8 * a.stable_step());
        b.step(0.8 * b.stable_step());
    }
    for (const VertexId n : a.mesh().nodes())
        ASSERT_EQ(a.positions()[n.index()], b.positions()[n.index()]);
}

// A block of tetrahedra is pushed at a free one of hexahedra, and pushes it along.
TEST(Contact, ActsBetweenTetrahedraAndHexahedra) {
    constexpr double apart = 0.005;  // m
    const Vec3 sizes = Vec3::Constant(0.5 * size);
    const double top = sizes.z() + 0.5 * apart;  // of the lower block
    topology::MeshData data =
        topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(), sizes, {3, 3, 3});
    const topology::MeshData upper = topology::box_mesh(
        topology::CellKind::tetrahedron, Vec3(0.004, 0.003, sizes.z() + apart), sizes, {3, 3, 3});
    const auto first = static_cast<std::int64_t>(data.points.size());
    data.points.insert(data.points.end(), upper.points.begin(), upper.points.end());
    for (std::size_t c = 0; c < upper.num_cells(); ++c) {
        std::vector<std::int64_t> corners(upper.cell(c).begin(), upper.cell(c).end());
        for (std::int64_t& corner : corners) corner += first;
        data.add_cell(upper.kinds[c], corners, 1);
    }
    WorldDef def;
    def.mesh = std::move(data);
    def.materials = {{1000.0, physics::HybridSprings{2000.0, 3000.0}},
                     {1000.0, physics::HyperElasticLinks{physics::NeoHookean{2000.0, 3000.0}}}};
    def.material_of_region = {{0, 0}, {1, 1}};
    World world(std::move(def));
    const auto upper_nodes = nodes_where(world, [&](const Vec3& x) { return x.z() > top; });
    world.add_load({.name = "push",
                    .kind = physics::NodalLoad{physics::VertexSet(upper_nodes), {0, 0, -0.01}}});
    std::size_t num_points = 0;
    double deepest = 0.0;  // m
    while (world.time() < 0.15) {
        const StepReport& report = world.step(0.8 * world.stable_step());
        num_points = std::max(num_points, report.contact.num_points);
        deepest = std::max(deepest, report.contact.max_penetration);
    }
    EXPECT_GT(num_points, 10u);
    EXPECT_LT(deepest, 1e-4);
    for (const VertexId n : world.mesh().nodes())
        EXPECT_LT(world.positions()[n.index()].z(), world.mesh().rest_position(n).z() - 0.01);
}

constexpr double pressed_by = 0.1 * size, pressed_in = 0.4;  // m, s

/// A cube with its ends glued to the floor and to a lid, which presses it.
World pressed(WorldDef def) {
    World world = held(World(std::move(def)));
    physics::Constraint lid{.name = "lid"};
    lid.nodes =
        physics::VertexSet(nodes_where(world, [](const Vec3& x) { return x.z() > size - 1e-9; }));
    lid.displacement =
        physics::TimeCurve<Vec3>({{0.0, Vec3::Zero()}, {pressed_in, -pressed_by * Vec3::UnitZ()}});
    world.add_constraint(std::move(lid));
    return world;
}

/// The force on the bottom of a pressed cube.
double pressing_force(double friction, bool is_cut) {
    WorldDef def = cube_at_rest(friction);
    def.mesh = cube(6);
    def.damping = 30.0;
    World world = pressed(std::move(def));
    run_until(world, 1.2,
              is_cut ? cut_along(world, {0.05, 0.05, 0.049}, {0.3, 0.1, 1.0}) : StepInputs());
    return world.reaction(world.constraints()[0]).force.z();
}

// A cut that is closed and cannot slip is no cut. Without friction the slope of the cut slips.
TEST(Contact, OfAClosedCutBearsWhatTheWholeBodyBears) {
    const double whole = pressing_force(0.0, false);
    EXPECT_GT(whole, 0.1);
    EXPECT_NEAR(pressing_force(0.5, true), whole, 0.005 * whole);
    EXPECT_LT(pressing_force(0.0, true), 0.9 * whole);
}

struct Ball {
    World world;
    ToolId ball;
};

/// A held cube, and a ball above the middle of its top.
Ball ball_above(double friction, double radius = 0.02) {
    WorldDef def = cube_at_rest();
    def.mesh = cube(8);
    def.damping = 20.0;
    World world = held(World(std::move(def)));
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{radius}, friction}});
    world.place_tool(ball, at({0.05, 0.05, size + radius}));
    return {std::move(world), ball};
}

/// Moves a tool on a straight line.
void move_tool(World& world, ToolId tool, const Vec3& to, double duration) {
    const Vec3 from = world.tool_pose(tool).position;
    const int num_steps = static_cast<int>(std::ceil(duration / (0.8 * world.stable_step())));
    for (int i = 1; i <= num_steps; ++i)
        world.step(duration / num_steps,
                   StepInputs().move(tool, at(from + (to - from) * i / num_steps)));
}

TEST(Contact, OfABallExertsWhatTheFloorBears) {
    auto [world, ball] = ball_above(0.0);
    move_tool(world, ball, {0.05, 0.05, size + 0.012}, 0.3);
    move_tool(world, ball, {0.05, 0.05, size + 0.012}, 0.7);
    const StepReport& report = world.report();
    ASSERT_EQ(report.tools.size(), 1u);
    const double floor = world.reaction(world.constraints()[0]).force.z();
    EXPECT_GT(report.tools[0].force.z(), 0.05);
    EXPECT_NEAR(report.tools[0].force.z(), floor, 0.01 * floor);
    EXPECT_LT(report.tools[0].force.head<2>().norm(), 0.1 * floor);
    EXPECT_LT(report.contact.max_penetration, 1e-5);
    // The ball has done the work that the tissue holds, but for what was lost.
    EXPECT_LT(world.ledger().energy_error(), 0.01);
}

TEST(Contact, OfASlidingBallHasItsFriction) {
    const auto drag = [](double friction) {
        auto [world, ball] = ball_above(friction);
        move_tool(world, ball, {0.05, 0.05, size + 0.014}, 0.3);
        move_tool(world, ball, {0.07, 0.05, size + 0.014}, 0.6);
        const Vec3 force = world.report().tools[0].force;
        return -force.x() / force.z();
    };
    EXPECT_NEAR(drag(0.0), 0.0, 0.08);  // soft tissue tilts in front of the ball
    EXPECT_NEAR(drag(0.3), 0.3, 0.08);
}

// A ball of 1,280 triangles exerts what a ball exerts.
TEST(Contact, OfASolidIsThatOfItsShape) {
    const auto force_on = [](const cutting::ProbeShape& shape) {
        WorldDef def = cube_at_rest();
        def.mesh = cube(8);
        def.damping = 20.0;
        World world = held(World(std::move(def)));
        const ToolId tool = world.add_tool({"ball", cutting::Probe{shape}});
        world.place_tool(tool, at({0.052, 0.049, size + 0.02}));
        move_tool(world, tool, {0.052, 0.049, size + 0.012}, 0.3);
        move_tool(world, tool, {0.052, 0.049, size + 0.012}, 0.5);
        EXPECT_LT(world.report().contact.max_penetration, 2e-5);
        return world.report().tools[0].force.z();
    };
    const double of_ball = force_on(cutting::Sphere{0.02});
    const double of_solid = force_on(cutting::Solid{test::icosphere(Vec3::Zero(), 0.02, 3)});
    EXPECT_NEAR(of_solid, of_ball, 0.015 * of_ball);
}

// The parts of a step are so short that the ball does not pass through the surface.
TEST(Contact, OfAFastSmallBallIsNotMissed) {
    auto [world, ball] = ball_above(0.0, 0.003);
    const auto down = StepInputs().move(ball, at({0.05, 0.05, size - 0.01}));
    EXPECT_GT(world.step(0.5 * world.stable_step(), down).num_substeps, 10u);
    double above = 0.0;
    for (const VertexId n : nodes_where(world, [](const Vec3& x) {
             return x.z() == size && std::hypot(x.x() - 0.05, x.y() - 0.05) < 1e-9;
         }))
        above = world.positions()[n.index()].z();
    EXPECT_LT(above, size - 0.01 - 0.0029);
    const auto far_up = StepInputs().move(ball, at({0.05, 0.05, 100.0}));
    EXPECT_NE(input_error_of([&] { world.step(0.5 * world.stable_step(), far_up); }).find("parts"),
              std::string::npos);
}

// Tools, constraints and gravity have changed the momentum, each by its mean force over the step.
TEST(Contact, InAStepOfPartsBalancesMomentum) {
    WorldDef def = soft_body();
    def.damping = 0.0;
    World world = held(World(std::move(def)));
    constexpr double radius = 0.003, move = 0.002;
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{radius}}});
    world.place_tool(ball, at({0.05, 0.05, size + radius}));
    const double dt = 0.5 * world.stable_step();
    double largest = 0.0;
    for (int i = 1; i <= 10; ++i) {
        const auto before = world.ledger().body_totals().totals;
        const StepReport& report =
            world.step(dt, StepInputs().move(ball, at({0.05, 0.05, size + radius - move * i})));
        EXPECT_GT(report.num_substeps, 1u);
        const Vec3 force = world.reaction(world.constraints()[0]).force - report.tools[0].force +
                           before.mass * Vec3(0, 0, -9.81);
        const Vec3 change = world.ledger().body_totals().totals.momentum - before.momentum;
        largest = std::max(largest, world.reaction(world.constraints()[0]).force.norm());
        EXPECT_LT((change - dt * force).norm(), 1e-11 * dt * largest) << i;
    }
}

// A tool that is put elsewhere meets what is there, and jaws open on the way.
TEST(Contact, OfAToolThatIsPlacedAnewIsWithWhatIsThere) {
    auto [world, ball] = ball_above(0.0, 0.01);
    world.step(0.5 * world.stable_step());
    world.place_tool(ball, at({0.02, 0.08, size + 0.01}));
    move_tool(world, ball, {0.02, 0.08, size + 0.006}, 0.1);
    EXPECT_GT(world.report().tools[0].force.z(), 0.005);

    const ToolId grasper = world.add_tool({"grasper", cutting::Grasper{cutting::Sphere{0.02}}});
    world.place_tool(grasper, at({0.08, 0.02, size}));
    EXPECT_GT(world.close_tool(grasper), 0u);
    world.place_tool(grasper, at({0.08, 0.02, 2.0 * size}));
    EXPECT_FALSE(world.is_tool_closed(grasper));
    world.step(0.5 * world.stable_step());
    EXPECT_EQ(world.report().tools[1].force, Vec3(Vec3::Zero()));
}

// Beside a lid that moves, points of contact depend on prescribed nodes: their work is the lid's.
TEST(Contact, BesideAMovingLidTakesEnergyAndGivesNone) {
    WorldDef def = cube_at_rest();
    def.damping = 20.0;
    World world = pressed(std::move(def));
    StepInputs inputs = cut_along(world, {0.05, 0.05, 0.9 * size}, {0.0, 0.02, 1.0});
    double work = 0.0;  // of the lid
    for (int i = 0; i < 400; ++i, inputs.clear()) {
        const double dt = 1e-3;
        world.step(dt, inputs);
        work += world.reaction(world.constraints()[1]).force.z() * -pressed_by / pressed_in * dt;
    }
    EXPECT_GT(work, 1e-4);
    EXPECT_NEAR(world.model().energetics().external_work(), work, 0.02 * work);
    EXPECT_GT(world.report().contact.dissipation, -0.005 * work);
    EXPECT_LT(world.report().contact.dissipation, 0.1 * work);
}

// Cut, pressed and slid, with impulses to begin with: the same bits after a pause, on two threads.
TEST(Contact, GoesOnWithTheSameBitsAfterRestore) {
    const auto press = [](Ball& b, int from, int to) {
        for (int i = from; i < to; ++i) {
            StepInputs inputs;
            if (i == 0) inputs = cut_along(b.world, {0.05, 0.05, 0.07}, {0.1, 0.05, 1.0});
            inputs.move(b.ball, at({0.05 + 2e-5 * i, 0.05, size + 0.02 - 4e-5 * i}));
            b.world.step(0.8 * b.world.stable_step(), inputs);
        }
    };
    Ball whole = ball_above(0.3);
    press(whole, 0, 300);
    EXPECT_GT(whole.world.report().contact.num_points, 20u);
    const std::string end = whole.world.save();
    for (const int pause : {3, 150, 299}) {
        Ball first = ball_above(0.3), second = ball_above(0.3);
        press(first, 0, pause);
        second.world.restore(first.world.save());
        second.world.set_num_threads(2);
        EXPECT_EQ(second.world.report().contact.dissipation,
                  first.world.report().contact.dissipation);
        press(second, pause, 300);
        EXPECT_TRUE(second.world.save() == end) << "pause at " << pause;
    }
}

/// How far a stiff block on a slope has slid after some time, over what a rigid one slides.
double slide_on_slope(double slope, double friction) {
    WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3(0, 0, 1e-6),
                                  Vec3(0.04, 0.04, 0.02), {4, 4, 2});
    def.materials = {{1000.0, physics::HyperElasticLinks{.law = physics::NeoHookean{7e4, 1e5},
                                                         .prony = {{0.5, 0.002}}}}};
    // The slope is level here, and gravity is oblique.
    const double angle = std::atan(slope), g = 9.81;
    def.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
    World world(std::move(def));
    const ToolId table = world.add_tool({"table", cutting::Probe{cutting::HalfSpace{}, friction}});
    world.place_tool(table, Pose());
    constexpr double time = 0.2;
    run_until(world, time);
    Vec3 moved = Vec3::Zero();
    for (const VertexId n : world.mesh().nodes())
        moved += world.positions()[n.index()] - world.mesh().rest_position(n);
    moved /= static_cast<double>(world.mesh().num_nodes());
    const double exact =
        0.5 * g * world.time() * world.time() * (std::sin(angle) - friction * std::cos(angle));
    return moved.x() / exact;
}

TEST(Contact, OfABlockOnASlopeSticksOrSlidesByCoulombsLaw) {
    EXPECT_NEAR(slide_on_slope(0.6, 0.4), 1.0, 0.02);
    EXPECT_NEAR(slide_on_slope(0.6, 0.0), 1.0, 0.02);
    EXPECT_NEAR(slide_on_slope(0.38, 0.4), 0.0, 0.05);  // of the negative way of a rigid one
}

/// A cube that hangs from its top, and a grasper at its bottom.
struct Held {
    World world;
    ToolId grasper;
};
Held held_by_grasper(double max_force = std::numeric_limits<double>::infinity()) {
    WorldDef def = cube_at_rest();
    def.damping = 20.0;
    World world(std::move(def));
    world.add_constraint({.name = "top",
                          .nodes = physics::VertexSet(nodes_where(
                              world, [](const Vec3& x) { return x.z() > size - 1e-9; }))});
    const ToolId grasper =
        world.add_tool({"grasper", cutting::Grasper{cutting::Sphere{0.03}, max_force}});
    world.place_tool(grasper, at({0.05, 0.05, 0.0}));
    EXPECT_GT(world.close_tool(grasper), 4u);
    return {std::move(world), grasper};
}

TEST(Contact, OfAGrasperCarriesTissueAndFeelsItsForce) {
    auto [world, grasper] = held_by_grasper();
    move_tool(world, grasper, {0.05, 0.05, -0.02}, 0.4);
    move_tool(world, grasper, {0.05, 0.05, -0.02}, 0.8);
    for (const VertexId n : nodes_where(world, [](const Vec3& x) {
             return x.z() == 0.0 && (x - Vec3(0.05, 0.05, 0.0)).norm() < 0.029;
         }))
        EXPECT_NEAR(world.positions()[n.index()].z(), world.mesh().rest_position(n).z() - 0.02,
                    1e-4);
    const double force = world.report().tools[0].force.z();  // tissue draws it up
    EXPECT_GT(force, 0.1);
    EXPECT_NEAR(force, world.reaction(world.constraints()[0]).force.z(), 0.01 * force);
    EXPECT_LT(world.ledger().energy_error(), 0.01);
    world.open_tool(grasper);
    EXPECT_FALSE(world.is_tool_closed(grasper));
    run_until(world, world.time() + 1.0);
    EXPECT_EQ(world.report().tools[0].force, Vec3(Vec3::Zero()));
    for (const VertexId n : nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }))
        EXPECT_NEAR(world.positions()[n.index()].z(), 0.0, 1e-4);
}

// Tissue slips out of jaws that are drawn away by more than they can hold.
// Jaws that are smaller than a face, in the middle of one.
TEST(Contact, OfAGrasperWithoutNodesHoldsAFace) {
    for (const cutting::CarverShape& jaws :
         {cutting::CarverShape(cutting::Cuboid{{0.004, 0.004, 0.004}}),
          cutting::CarverShape(cutting::Sphere{0.002})}) {
        World world = held_world();
        const ToolId grasper = world.add_tool({"grasper", cutting::Grasper{jaws}});
        const Vec3 place(size, 0.035, 0.04);  // on the side x = size
        world.place_tool(grasper, at(place));
        EXPECT_EQ(world.close_tool(grasper), 1u);
        EXPECT_EQ(world.num_held(grasper), 1u);
        run_until(world, 0.05);
        // It bears a part of the weight of the cube, which hangs in it.
        EXPECT_LT(world.report().tools[0].force.z(), 0.0);
        world.open_tool(grasper);
        EXPECT_EQ(world.num_held(grasper), 0u);
    }
}

TEST(Contact, OfAGrasperSlipsAboveItsLargestForce) {
    auto [free, holding] = held_by_grasper();
    move_tool(free, holding, {0.05, 0.05, -0.02}, 0.4);
    const double needed = free.report().tools[0].force.z();
    auto [world, grasper] = held_by_grasper(0.3 * needed);
    double largest = 0.0;
    for (int i = 1; i <= 20; ++i) {
        move_tool(world, grasper, {0.05, 0.05, -0.004 * i}, 0.05);
        largest = std::max(largest, world.report().tools[0].force.norm());
    }
    EXPECT_LE(largest, 0.3 * needed * (1.0 + 1e-9));
    EXPECT_GT(largest, 0.2 * needed);
    EXPECT_TRUE(world.is_tool_closed(grasper));
    EXPECT_EQ(world.report().tools[0].force, Vec3(Vec3::Zero()));  // all has slipped out
}

TEST(Contact, OfAGrasperGoesOnWithTheSameBitsAfterRestore) {
    const auto pull = [](Held& h, int from, int to) {
        for (int i = from; i < to; ++i) {
            StepInputs inputs;
            if (i == 40) inputs = cut_along(h.world, {0.05, 0.05, 0.01}, {1.0, 0.2, 0.1});
            inputs.move(h.grasper, at({0.05, 0.05, -1e-4 * i}));
            h.world.step(0.8 * h.world.stable_step(), inputs);
        }
    };
    Held whole = held_by_grasper(0.2);
    pull(whole, 0, 150);
    const std::string end = whole.world.save();
    for (const int pause : {1, 41, 120}) {
        Held first = held_by_grasper(0.2), second = held_by_grasper(0.2);
        pull(first, 0, pause);
        second.world.restore(first.world.save());
        pull(second, pause, 150);
        EXPECT_TRUE(second.world.save() == end) << "pause at " << pause;
    }
}

TEST(Contact, RefusesWhatItCannotDo) {
    const cutting::Probe ball{cutting::Sphere{0.01}};
    for (const Solver solver : {Solver::implicit_euler, Solver::statics}) {
        World world(soft_body(solver));
        EXPECT_NE(input_error_of([&] {
                      world.add_tool({"ball", ball});
                  }).find("explicit solver"),
                  std::string::npos);
    }
    World world(soft_body());
    const ToolId away = world.add_tool({"jaws", cutting::Grasper{cutting::Sphere{0.01}}});
    EXPECT_NE(input_error_of([&] { world.close_tool(away); }).find("not there"), std::string::npos);
    const ToolId blade = world.add_tool(scalpel());
    EXPECT_NE(input_error_of([&] { world.open_tool(blade); }).find("no jaws"), std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  world.add_tool({"jaws", cutting::Grasper{cutting::Sphere{0.01}, 0.0}});
              }).find("force"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  world.add_tool({"ball", cutting::Probe{cutting::Sphere{0.0}}});
              }).find("radius"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  world.add_tool({"ball", cutting::Probe{cutting::Sphere{0.1}, -1.0}});
              }).find("friction"),
              std::string::npos);
    EXPECT_NE(
        input_error_of([&] {
            world.add_tool({"table", cutting::Probe{cutting::HalfSpace{.normal = {0, 0, 2}}}});
        }).find("normal"),
        std::string::npos);
    WorldDef def = soft_body();
    def.contact.friction = -0.1;
    EXPECT_NE(input_error_of([&] { const World none(std::move(def)); }).find("friction"),
              std::string::npos);
}

}  // namespace
}  // namespace incise::sim
