// The force that it takes to cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "support/mesh_families.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

using cutting::CuttingForce;

/// The cube without gravity, stiff enough for a toughness of 5 J/m2.
WorldDef gel(int cells = 6) {
    WorldDef def = soft_body();
    def.mesh = cube(cells);
    def.gravity.setZero();
    def.damping = 5.0;
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{1700.0, 15000.0}}}};
    return def;
}

/// A blade whose edge lies across the cube and overhangs it, turned about the vertical.
ToolDef wire(double toughness, CuttingForce force, double turn = 0.0) {
    const Vec3 along(-std::sin(turn), std::cos(turn), 0.0);
    return {"wire", Blade{{-0.9 * size * along, 0.9 * size * along},
                          CutMode::split,
                          cutting::default_snap,
                          toughness,
                          force}};
}

struct Cut {
    double mean_force = 0.0, largest_force = 0.0;  // against the way, N
    double sideways = 0.0;                         // N, mean
    double work = 0.0;                             // J, of the hand
    double area = 0.0;                             // m2, opened
    StepReport last;
    double energy_error = 0.0, energy_scale = 0.0, external_work = 0.0;
};

/// Draws a wire through the middle of the cube along x, from outside to three quarters of it.
Cut draw_wire(World world, const ToolDef& def) {
    const ToolId tool = world.add_tool(def);
    const auto pose = [](double x) { return at({x, 0.5 * size, 0.507 * size}); };
    constexpr double speed = 0.1, from = -0.08, to = 0.75 * size;  // m/s, m
    world.place_tool(tool, pose(from));
    Cut cut;
    int count = 0;
    while (world.time() < (to - from) / speed) {
        const double x = from + speed * world.time();
        const double end = std::min(world.time() + 0.8 * world.stable_step(), (to - from) / speed);
        cut.last = world.step_to(end, StepInputs().move(tool, pose(from + speed * end)));
        const Vec3 force = cut.last.tools.at(0).force;
        cut.work -= force.x() * (from + speed * end - x);
        cut.largest_force = std::max(cut.largest_force, -force.x());
        for (const Edit& edit : cut.last.edits) cut.area += edit.record.cut_area;
        if (x < 0.3 * size) continue;
        cut.mean_force -= force.x();
        cut.sideways += force.y();
        ++count;
    }
    cut.mean_force /= count;
    cut.sideways /= count;
    cut.energy_error = world.ledger().energy_error();
    cut.external_work = world.ledger().body_totals().external_work;
    return cut;
}

TEST(CuttingForce, ThatIsReportedIsTheToughnessTimesTheWidth) {
    const Cut cut = draw_wire(held(World(gel())), wire(5.0, CuttingForce::report));
    EXPECT_NEAR(cut.mean_force, 5.0 * size, 0.02 * 5.0 * size);
    // The cut is open up to the last element that the wire has passed.
    const double swept = cut.last.contact.fracture_energy / 5.0;
    EXPECT_GT(swept, cut.area);
    EXPECT_LT(swept, cut.area + size * size / 6);
    EXPECT_NEAR(cut.work, cut.last.contact.fracture_energy, 1e-12);
    EXPECT_EQ(cut.external_work, 0.0);  // it is not exerted
    EXPECT_EQ(cut.sideways, 0.0);
}

// The parts of other cells have faces with corners on straight sides.
TEST(CuttingForce, IsTheToughnessTimesTheWidthInCellsOfAllKinds) {
    using test::Bricks;
    for (const auto bricks : {Bricks::hexahedra, Bricks::wedges, Bricks::pyramids, Bricks::mixed}) {
        SCOPED_TRACE(static_cast<int>(bricks));
        WorldDef def = gel();
        topology::MeshData mesh = test::brick_cube(bricks, 6, 0.0, 1);
        for (Vec3& x : mesh.points) x *= size;
        def.mesh = std::move(mesh);
        const Cut cut = draw_wire(held(World(std::move(def))), wire(5.0, CuttingForce::report));
        // Behind each opened plane of the mesh, the wire counts as outside the tissue over 0.03 of
        // a cell: `surface_layer` of blade_contact.cpp.
        EXPECT_NEAR(cut.mean_force, 5.0 * size, 0.03 * 5.0 * size);
    }
}

TEST(CuttingForce, ThatIsReportedChangesNothingElse) {
    const auto state_after = [](double toughness) {
        World world = held(World(gel(4)));
        const ToolId tool = world.add_tool(wire(toughness, CuttingForce::report));
        world.place_tool(tool, at({-0.08, 0.5 * size, 0.507 * size}));
        for (int i = 1; i <= 60; ++i) {
            const Pose pose = at({-0.08 + 0.0025 * i, 0.5 * size, 0.507 * size});
            world.step(0.5 * world.rest_stable_step(), StepInputs().move(tool, pose));
        }
        return std::vector<Vec3>(world.positions().begin(), world.positions().end());
    };
    EXPECT_EQ(state_after(0.0), state_after(5.0));
}

// A blade that is turned in its plane slides along itself as well: the force falls by the cosine,
// and the width grows by it.
TEST(CuttingForce, OfABladeThatSlicesIsLowerForItsLength) {
    const Cut straight = draw_wire(held(World(gel())), wire(5.0, CuttingForce::report));
    const Cut turned = draw_wire(held(World(gel())), wire(5.0, CuttingForce::report, 0.6));
    EXPECT_NEAR(turned.mean_force, straight.mean_force, 0.03 * straight.mean_force);
    constexpr double quarter_turn = 0.5 * std::numbers::pi;
    const Cut along = draw_wire(held(World(gel())), wire(5.0, CuttingForce::report, quarter_turn));
    EXPECT_LT(along.mean_force, 0.02 * straight.mean_force);
}

TEST(CuttingForce, ThatIsAppliedDentsTheTissueFirstAndClosesTheBalance) {
    const Cut cut = draw_wire(held(World(gel())), wire(5.0, CuttingForce::apply));
    EXPECT_NEAR(cut.mean_force, 5.0 * size, 0.03 * 5.0 * size);
    EXPECT_NEAR(cut.largest_force, 5.0 * size, 0.05 * 5.0 * size);
    EXPECT_NEAR(cut.external_work, cut.work, 1e-3 * cut.work);
    EXPECT_LT(cut.energy_error, 1e-3);
    // What the hand does is fracture, but for what the dent holds and damping takes.
    const double fracture = cut.last.contact.fracture_energy;
    EXPECT_GT(cut.work, fracture);
    EXPECT_LT(cut.work, 1.1 * fracture);
    EXPECT_GT(fracture, 5.0 * cut.area);
    EXPECT_LT(fracture, 5.0 * (cut.area + size * size / 6));
}

TEST(CuttingForce, BelowItsThresholdOnlyPushes) {
    // The wire moves by less than the dent at which it would cut. It sticks where it is in the
    // tissue by a part of an element: at most a tenth, as docs/contact.md says.
    World world = held(World(gel()));
    const ToolId tool = world.add_tool(wire(20.0, CuttingForce::apply));
    const auto pose = [](double x) { return at({x, 0.5 * size, 0.507 * size}); };
    world.place_tool(tool, pose(-0.001));
    double area = 0.0;
    for (int i = 1; i <= 2000; ++i) {
        const auto inputs = StepInputs().move(tool, pose(std::min(-0.001 + 4e-6 * i, 0.003)));
        for (const Edit& edit : world.step(0.8 * world.stable_step(), inputs).edits)
            area += edit.record.cut_area;
    }
    EXPECT_LT(area, 0.1 * (size / 6) * size);
    const double force = -world.report().tools.at(0).force.x();
    EXPECT_GT(force, 0.05);
    EXPECT_LT(force, 20.0 * size);
    // At rest the floor bears it.
    EXPECT_NEAR(-world.reaction(world.constraints()[0]).force.x(), force, 0.02 * force);
}

TEST(CuttingForce, GoesOnBitForBitAfterARestore) {
    World world = held(World(gel(4)));
    const ToolId tool = world.add_tool(wire(5.0, CuttingForce::apply));
    const auto pose = [](int i) { return at({-0.08 + 0.0005 * i, 0.5 * size, 0.507 * size}); };
    world.place_tool(tool, pose(0));
    const auto go = [&](World& one, int from, int to) {
        for (int i = from + 1; i <= to; ++i)
            one.step(0.5 * one.rest_stable_step(), StepInputs().move(tool, pose(i)));
    };
    go(world, 0, 200);
    World other(gel(4));
    other.restore(world.save());
    for (World* one : {&world, &other}) go(*one, 200, 260);
    EXPECT_EQ(world.save(), other.save());
    EXPECT_GT(other.report().contact.fracture_energy, 0.0);
}

TEST(CuttingForce, IsRefusedAboveItsLimit) {
    World world(gel());
    const std::string refusal =
        input_error_of([&] { world.add_tool(wire(1000.0, CuttingForce::apply)); });
    EXPECT_NE(refusal.find("a toughness of 1000 J/m2 cannot be applied"), std::string::npos);
    EXPECT_NO_THROW(world.add_tool(wire(1000.0, CuttingForce::report)));
    EXPECT_NE(input_error_of([&] {
                  world.add_tool(wire(-1.0, CuttingForce::report));
              }).find("toughness is -1"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] {
                  world.add_tool(wire(0.0, CuttingForce::apply));
              }).find("needs a toughness"),
              std::string::npos);
}

}  // namespace
}  // namespace incise::sim
