// Materials, gravity, damping, constraints and loads of a world are changed between two steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "incise/contact/tool_contact.h"
#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

using ::testing::HasSubstr;

physics::Material stiffer(const physics::Material& material) {
    physics::Material by = material;
    if (auto* links = std::get_if<physics::HyperElasticLinks>(&by.method))
        links->law = physics::NeoHookean{500.0, 1500.0};
    else
        by.method = physics::HybridSprings{900.0, 500.0};
    return by;
}

/// A world that has been bent, and cut if its elements can be.
World moved_world(WorldDef def, bool is_cut) {
    World world = held(World(std::move(def)));
    run_until(world, 0.02,
              is_cut ? cut_along(world, {0.05, 0.05, 0.05}, {1, 0.2, 0.1}) : StepInputs());
    return world;
}

TEST(WorldChanges, AMaterialGivesTheForcesOfABodyThatIsMadeOfIt) {
    for (const auto& [name, body] : resumable_bodies())
        for (const bool is_cut : {false, true}) {
            SCOPED_TRACE(name);
            WorldDef def = body();
            // Viscous stress of the law has jumped, and the terms have kept theirs: no such body
            // is made at once.
            const auto* links = std::get_if<physics::HyperElasticLinks>(&def.materials[0].method);
            if (links && !links->prony.empty()) continue;
            World world = moved_world(body(), is_cut);
            const physics::Material by = stiffer(def.materials[0]);
            world.set_material(by);
            const physics::Model& model = world.model();
            physics::Model made(world.mesh(), model.fragments(),
                                {{by}, {{0, 0}}, {}, def.precision});
            made.set_state(model.positions(), model.velocities(), world.time());
            for (const NodeId n : model.fragments().nodes()) {
                ASSERT_EQ(model.elastic_forces()[n.index()], made.elastic_forces()[n.index()]);
                ASSERT_EQ(model.masses()[n.index()], made.masses()[n.index()]);
            }
            EXPECT_EQ(model.structure().rest_stable_step(), made.structure().rest_stable_step());
            EXPECT_EQ(model.energetics().elastic_energy(), made.energetics().elastic_energy());
            EXPECT_LE(world.stable_step(), world.rest_stable_step());
        }
}

TEST(WorldChanges, TheJumpOfElasticEnergyIsExternalWork) {
    for (const auto& [name, body] : resumable_bodies()) {
        SCOPED_TRACE(name);
        WorldDef def = body();
        World world = moved_world(body(), false);
        const double work = world.model().energetics().external_work(),
                     elastic = world.model().energetics().elastic_energy();
        world.set_material(stiffer(def.materials[0]));
        const double jump = world.model().energetics().elastic_energy() - elastic;
        EXPECT_GT(jump, 0.1 * elastic);
        EXPECT_NEAR(world.model().energetics().external_work() - work, jump,
                    1e-12 * std::abs(work));
        EXPECT_EQ(world.ledger().mass_error(), 0.0);
    }
}

// What is the same goes on with the same bits: positions, velocities and viscous stress.
TEST(WorldChanges, TheSameMaterialChangesNothing) {
    for (const auto& [name, body] : resumable_bodies()) {
        SCOPED_TRACE(name);
        const WorldDef def = body();
        World world = moved_world(body(), false), other = moved_world(body(), false);
        world.set_material(def.materials[0]);
        for (int i = 0; i < 20; ++i) {
            world.step(0.1 * world.rest_stable_step());
            other.step(0.1 * other.rest_stable_step());
        }
        for (const VertexId n : world.mesh().nodes())
            ASSERT_EQ(world.positions()[n.index()], other.positions()[n.index()]);
        EXPECT_TRUE(std::ranges::equal(world.model().state().history().values(),
                                       other.model().state().history().values()));
    }
}

// A body under load becomes viscous, or loses that: its stress relaxes from then on, or at once.
TEST(WorldChanges, ViscosityComesAndGoes) {
    const WorldDef def = soft_body();
    physics::Material viscous = def.materials[0];
    std::get<physics::HyperElasticLinks>(viscous.method).prony = {{0.4, 0.05}};
    World world = held(World(soft_body()));
    run_until(world, 0.02);
    EXPECT_TRUE(world.model().state().history().is_empty());
    world.set_material(viscous);
    const double long_time = world.model().energetics().elastic_energy();
    EXPECT_FALSE(world.model().state().history().is_empty());
    run_until(world, 0.04);
    world.set_material(def.materials[0]);
    EXPECT_TRUE(world.model().state().history().is_empty());
    EXPECT_GT(world.model().energetics().elastic_energy(), 0.0);
    EXPECT_GT(long_time, 0.0);
    run_until(world, 0.05);
    EXPECT_LT(world.ledger().energy_error(), 0.02);
}

TEST(WorldChanges, ARegionAloneGetsAMaterial) {
    WorldDef def = soft_body();
    auto mesh = cube();
    for (std::size_t i = 0; i < mesh.regions.size(); ++i) mesh.regions[i] = int(i % 3);
    def.mesh = std::move(mesh);
    const physics::Material material = def.materials[0];
    World world = held(World(std::move(def)));
    run_until(world, 0.01);
    const auto stress_in = [&](int region) {
        std::vector<double> all;
        const auto results = world.cell_results();
        std::size_t i = 0;
        for (const CellId e : world.mesh().elements()) {
            if (world.mesh().region(e) == region) all.push_back(results[i].energy);
            ++i;
        }
        return all;
    };
    const auto first = stress_in(0), second = stress_in(1);
    const std::array regions{1};
    world.set_material(stiffer(material), regions);
    EXPECT_EQ(stress_in(0), first);
    EXPECT_NE(stress_in(1), second);
    EXPECT_EQ(world.model().structure().elements().materials().materials.size(), 2u);
    // Materials that no region has are forgotten.
    world.set_material(material);
    EXPECT_EQ(world.model().structure().elements().materials().materials.size(), 1u);
    EXPECT_EQ(stress_in(1), second);
}

TEST(WorldChanges, FibresComeWithTheirDirection) {
    World world = held_world();
    const physics::Material plain = world.model().structure().elements().materials().materials[0];
    run_until(world, 0.01);
    const physics::Material fibrous{
        1000.0, physics::HyperElasticLinks{physics::HolzapfelGasserOgden{
                    .mu = 200.0, .bulk_modulus = 700.0, .k1 = 1000.0, .k2 = 1.0}}};
    EXPECT_THAT(input_error_of([&] { world.set_material(fibrous); }),
                HasSubstr("no direction of fibres"));
    EXPECT_THAT(input_error_of([&] { world.set_material(fibrous, {}, Vec3(0, 0, 2)); }),
                HasSubstr("must be 1"));
    const UndoPoint before = world.undo_point();
    const std::string bytes = world.save();
    world.set_material(fibrous, {}, Vec3::UnitZ());
    EXPECT_FALSE(world.model().structure().fibres().empty());
    run_until(world, 0.02, cut_along(world, {0.05, 0.05, 0.05}, {1, 0.2, 0.1}));
    world.set_material(plain);
    EXPECT_TRUE(world.model().structure().fibres().empty());
    world.undo(before);
    EXPECT_TRUE(world.save() == bytes);
}

TEST(WorldChanges, GravityAndDampingAreThoseOfAWorldThatBeginsWithThem) {
    World expected = held_world();
    WorldDef def = soft_body();
    def.gravity = {1, 2, 3};
    def.damping = 0.0;
    World world = held(World(std::move(def)));
    world.set_gravity({0, 0, -9.81});
    world.set_damping(2.0);
    run_until(expected, 0.02);
    run_until(world, 0.02);
    EXPECT_EQ(world.time(), expected.time());
    for (const VertexId n : world.mesh().nodes()) {
        ASSERT_EQ(world.positions()[n.index()], expected.positions()[n.index()]);
        ASSERT_EQ(world.velocities()[n.index()], expected.velocities()[n.index()]);
    }
    // While it runs, weightlessness ends what gravity does.
    world.set_gravity(Vec3::Zero());
    world.set_damping(20.0);
    run_until(world, 1.0);
    EXPECT_LT(world.model().max_displacement(), 0.05 * expected.model().max_displacement());
}

TEST(WorldChanges, LoadsAndConstraintsAreReplacedInTheirPlace) {
    const auto top = [](const World& world) {
        return physics::VertexSet(nodes_where(world, [](const Vec3& x) { return x.z() == size; }));
    };
    const auto push = [&](const World& world, const Vec3& force) {
        return physics::Load{"push", physics::NodalLoad{top(world), force, {}}, {}};
    };
    const auto hold = [&](const World& world, const std::array<bool, 3>& axes) {
        return physics::Constraint{.name = "hold", .nodes = top(world), .components = axes};
    };
    World world = held_world(), expected = held_world();
    const LoadId load = world.add_load(push(world, {0, 0, 1e-3}));
    const ConstraintId constraint = world.add_constraint(hold(world, {true, true, true}));
    world.set_load(load, push(world, {2e-4, 0, 0}));
    world.set_constraint(constraint, hold(world, {false, true, false}));
    expected.add_load(push(expected, {2e-4, 0, 0}));
    expected.add_constraint(hold(expected, {false, true, false}));
    run_until(world, 0.02);
    run_until(expected, 0.02);
    for (const VertexId n : world.mesh().nodes())
        ASSERT_EQ(world.positions()[n.index()], expected.positions()[n.index()]);
    EXPECT_EQ(world.reaction(constraint).force,
              expected.reaction(expected.constraints().back()).force);
    world.remove_load(load);
    world.release(constraint);
    EXPECT_THAT(input_error_of([&] {
                    world.set_load(load, push(world, {1, 0, 0}));
                }),
                HasSubstr("no longer there"));
}

TEST(WorldChanges, AreTakenBackByUndo) {
    for (const auto& [name, body] : resumable_bodies()) {
        SCOPED_TRACE(name);
        const WorldDef def = body();
        World world = held(World(body()));
        std::vector<std::pair<UndoPoint, std::string>> moments;
        const auto note = [&] { moments.emplace_back(world.undo_point(), world.save()); };
        const auto step = [&](double x) {
            run_until(world, world.time() + 0.005,
                      cut_along(world, {x, 0.05, 0.05}, {1, 0.2, 0.1}));
        };
        note();
        step(0.03);
        note();
        world.set_material(stiffer(def.materials[0]));
        note();
        world.set_gravity({3, 0, 0});
        world.set_damping(1.0);
        step(0.05);
        note();
        world.set_material(def.materials[0]);
        const LoadId load = world.add_load(
            {"push",
             physics::NodalLoad{physics::VertexSet(nodes_where(
                                    world, [](const Vec3& x) { return x.z() == size; })),
                                {0, 0, 1e-4},
                                {}},
             {}});
        step(0.07);
        note();
        world.set_load_factor(load, 2.0);
        world.remove_load(load);
        step(0.08);
        for (; !moments.empty(); moments.pop_back())
            for (int time = 0; time < 2; ++time) {
                SCOPED_TRACE(moments.size());
                world.undo(moments.back().first);
                ASSERT_TRUE(world.save() == moments.back().second);
                world.set_material(stiffer(def.materials[0]));
                step(0.06);
            }
    }
}

// Without edits between them, both of two moments can be gone back to from the other.
TEST(WorldChanges, AMomentBeforeAndOneAfterAreBothGoneBackTo) {
    World world = held_world();
    const physics::Material plain = world.model().structure().elements().materials().materials[0];
    run_until(world, 0.01);
    const UndoPoint before = world.undo_point();
    const std::string bytes_before = world.save();
    world.set_material(stiffer(plain));
    const UndoPoint after = world.undo_point();
    const std::string bytes_after = world.save();
    for (int i = 0; i < 3; ++i) {
        world.undo(before);
        ASSERT_TRUE(world.save() == bytes_before);
        run_until(world, world.time() + 0.002);
        world.undo(after);
        ASSERT_TRUE(world.save() == bytes_after);
        run_until(world, world.time() + 0.002);
    }
}

// Bytes of before fit again when a material comes back, in whatever order regions are changed.
TEST(WorldChanges, AMaterialThatComesBackGivesTheStateOfBefore) {
    WorldDef def = soft_body();
    auto mesh = cube();
    for (std::size_t i = 0; i < mesh.regions.size(); ++i) mesh.regions[i] = int(i % 3);
    def.mesh = std::move(mesh);
    const physics::Material first = def.materials[0], second = stiffer(first);
    def.materials.push_back(second);
    def.material_of_region = {{0, 1}, {1, 0}, {2, 1}};
    World world = held(World(std::move(def)));
    run_until(world, 0.01);
    const std::string bytes = world.save();
    for (const int region : {1, 0, 2}) {
        SCOPED_TRACE(region);
        const std::array changed{region};
        physics::Material third = first;
        third.method = physics::HyperElasticLinks{physics::NeoHookean{300.0, 900.0}};
        world.set_material(third, changed);
        EXPECT_THAT(input_error_of([&] { world.restore(bytes); }), HasSubstr("other materials"));
        if (region != 1) break;  // 0 and 2 have shared one: they are apart now
        world.set_material(first, changed);
        EXPECT_NO_THROW(world.restore(bytes));
        EXPECT_TRUE(world.save() == bytes);
    }
}

// The stable step follows at once, and does not fall back later to what it was.
TEST(WorldChanges, SofterTissueTakesLongerStepsFromThenOn) {
    World world = held_world();
    const physics::Material plain = world.model().structure().elements().materials().materials[0];
    physics::Material soft = plain;
    soft.method = physics::HyperElasticLinks{physics::NeoHookean{2.0, 6.0}};
    world.set_gravity(Vec3::Zero());
    run_until(world, 0.05);
    const double before = world.stable_step();
    world.set_material(soft);
    EXPECT_GT(world.stable_step(), 5.0 * before);
    for (int i = 0; i < 2500; ++i) {
        world.step(0.2 * world.rest_stable_step());
        ASSERT_GT(world.stable_step(), 2.0 * before);
    }
}

TEST(WorldChanges, ThatAreWrongAreRefusedAndChangeNothing) {
    WorldDef def = soft_body();
    def.contact.enabled = true;
    const physics::Material plain = def.materials[0];
    World world = held(World(std::move(def)));
    run_until(world, 0.01);
    const ConstraintId hand = world.grasp(
        "hand", nodes_where(world, [](const Vec3& x) { return x.z() == size; }), Pose());
    Blade blade{{{0, -0.02, 0}, {0, 0.12, 0}}};
    blade.toughness = 0.02;
    blade.cutting_force = cutting::CuttingForce::apply;
    world.add_tool({"sharp", blade});
    physics::Material dense = plain, broken = plain, soft = plain, springs = plain;
    dense.density = 1001.0;
    broken.method = physics::HyperElasticLinks{physics::NeoHookean{-1.0, 600.0}};
    soft.method = physics::HyperElasticLinks{physics::NeoHookean{1e-6, 3e-6}};
    springs.method = physics::HybridSprings{400.0, 400.0};
    const std::array regions{4};
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const physics::Constraint nothing{.name = "nothing"};
    const std::string before = world.save();
    const std::vector<std::pair<std::function<void()>, std::string>> refused = {
        {[&] { world.set_material(dense); }, "tissue keeps its mass"},
        {[&] { world.set_material(broken); }, "shear modulus"},
        {[&] { world.set_material(springs); }, "needs hexahedra"},
        {[&] { world.set_material(soft); }, "toughness"},
        {[&] { world.set_material(plain, regions); }, "no region 4"},
        {[&] {
             world.set_gravity({0, nan, 0});
         },
         "gravity is not finite"},
        {[&] { world.set_damping(-1.0); }, "must be 0 or more"},
        {[&] { world.set_constraint(hand, nothing); }, "is a grasp"},
        {[&] { world.set_constraint(world.constraints()[0], nothing); }, "no node"},
        {[&] { world.set_constraint({}, nothing); }, "names no constraint"},
        {[&] { world.set_load({}, {}); }, "names no load"}};
    for (const auto& [change, text] : refused) {
        SCOPED_TRACE(text);
        EXPECT_THAT(input_error_of(change), HasSubstr(text));
        EXPECT_TRUE(world.save() == before);
    }
}

// The forces at the points add up to what the tool feels, for probes and jaws.
TEST(ToolContacts, AddUpToTheForceOnTheTool) {
    WorldDef def = soft_body();
    def.gravity = Vec3::Zero();
    def.contact = {.enabled = true, .friction = 0.3};
    World world = held(World(std::move(def)));
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{0.02}, 0.4}});
    const ToolId jaws = world.add_tool({"jaws", cutting::Grasper{cutting::Sphere{0.02}}});
    EXPECT_TRUE(world.tool_contacts(ball).empty());
    world.place_tool(ball, at({0.03, 0.05, size + 0.0201}));
    world.place_tool(jaws, at({0.1, 0.05, 0.08}));
    ASSERT_GT(world.close_tool(jaws), 0u);
    int num_pressed = 0;
    for (int i = 0; i < 400; ++i) {
        const StepInputs inputs =
            StepInputs()
                .move(ball, at({0.03 + 1e-5 * i, 0.05, size + 0.0201 - 1e-5 * i}))
                .move(jaws, at({0.1 + 1e-5 * i, 0.05, 0.08}));
        const StepReport& report = world.step(0.5 * world.rest_stable_step(), inputs);
        if (report.num_substeps > 1) continue;
        for (const ToolState& state : report.tools) {
            const auto points = world.tool_contacts(state.tool);
            Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
            for (const contact::ToolContactPoint& point : points) {
                sum += point.normal_force + point.friction_force;
                torque += (point.point - state.pose.position)
                              .cross(point.normal_force + point.friction_force);
                EXPECT_EQ(point.region, 0);
                if (state.tool == jaws) continue;
                EXPECT_NEAR(point.normal.norm(), 1.0, 1e-12);
                EXPECT_GE(point.normal_force.dot(point.normal), 0.0);
                EXPECT_NEAR(point.friction_force.dot(point.normal), 0.0, 1e-12);
                EXPECT_LE(point.friction_force.norm(),
                          0.4 * point.normal_force.norm() * (1.0 + 1e-9) + 1e-15);
                // On the ball, and its normal goes to the centre.
                const Vec3 before = state.pose.position - Vec3(1e-5, 0, -1e-5);
                EXPECT_NEAR((point.point - before).norm(), 0.02, 1e-3);
                ++num_pressed;
            }
            EXPECT_NEAR((sum - state.force).norm(), 0.0, 1e-12 * (1.0 + state.force.norm()));
        }
    }
    EXPECT_GT(num_pressed, 100);
    EXPECT_FALSE(world.tool_contacts(jaws).empty());
    world.open_tool(jaws);
    EXPECT_TRUE(world.tool_contacts(jaws).empty());
    const std::string bytes = world.save();
    world.restore(bytes);
    EXPECT_TRUE(world.tool_contacts(ball).empty());
}

}  // namespace
}  // namespace incise::sim
