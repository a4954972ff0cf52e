// What a world refuses: wrong calls, wrong definitions and bytes of other worlds.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

using cutting::Blade;

TEST(World, MisuseIsRefusedAndChangesNothing) {
    Session session(held_world());
    session.run(0, 20);
    World& world = session.world();
    const std::string before = world.save();
    const double nan = std::nan(""), bound = world.rest_stable_step();
    const physics::VertexSet floor(nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }));
    const std::vector<std::pair<std::function<void()>, const char*>> misuses = {
        {[&] { world.step(0.0); }, "it must be above 0"},
        {[&] { world.step(-1e-3); }, "it must be above 0"},
        {[&] { world.step(nan); }, "it must be above 0"},
        {[&] { world.step(1.01 * bound); }, "is above the stable step of"},
        {[&] { world.step_to(world.time()); }, "it must go forward"},
        {[&] { world.require_possible(StepInputs().move(ToolId{7}, {})); }, "names no tool"},
        {[&] { world.require_possible(StepInputs().withdraw({3})); }, "names no tool"},
        {[&] { world.place_tool(world.tools()[0], {}); }, "withdraw it before it is put elsewhere"},
        {[&] {
             world.require_possible(StepInputs().move(world.tools()[0], at({nan, 0, 0})));
         },
         "its pose must have"},
        {[&] {
             world.require_possible(StepInputs().move(
                 world.tools()[0], {Eigen::Quaterniond(2, 0, 0, 0), Vec3::Zero()}));
         },
         "its pose must have"},
        {[&] {
             world.add_tool({"stick", Blade{{{0, 0, 0}}}});
         },
         "needs at least 2 points"},
        {[&] {
             world.add_tool({"burr", cutting::Carver{cutting::Sphere{0.0}}});
         },
         "it must be above 0"},
        {[&] {
             world.add_tool({"plane", cutting::PlaneCut{Vec3::Zero(), Vec3::Zero()}});
         },
         "the normal of its plane is zero"},
        {[&] {
             world.add_constraint(
                 {.name = "more",
                  .nodes = floor,
                  .displacement = physics::TimeCurve<Vec3>({{0.0, Vec3::Ones()}})});
         },
         "is held in x by both 'floor' and 'more'"},
        {[&] { world.add_constraint({.name = "none"}); }, "it has no node"},
        {[&] { world.grasp("hand", {VertexId(99999)}, {}); }, "there is no node 99999"},
        {[&] { world.require_possible(StepInputs().move(world.constraints()[0], {})); },
         "is no grasp"},
        {[&] { world.require_possible(StepInputs().move(ConstraintId{9}, {})); },
         "names no constraint"},
        {[&] { world.release({9}); }, "names no constraint"},
        {[&] { world.remove_load({4}); }, "names no load"},
        {[&] {
             world.add_load(
                 {.name = "wind", .kind = physics::TractionLoad{{{{CellId(3), 9}}}, {}}});
         },
         "is not on the surface"},
        {[&] {
             physics::Constraint grip =
                 physics::make_grip("hand", {VertexId(124)}, at({0, 0, size}));
             grip.gripped[NodeId(124)] = Vec3::Zero();
             world.add_constraint(std::move(grip));
         },
         "positions in a grip must be empty"},
        {[&] {
             physics::Constraint grip =
                 physics::make_grip("hand", {VertexId(124)}, at({0, 0, size}));
             grip.grip = physics::TimeCurve<Pose>({{1.0, Pose()}, {0.0, Pose()}});
             world.add_constraint(std::move(grip));
         },
         "times do not ascend"},
        {[&] {
             physics::NodalLoad load{physics::VertexSet(std::vector{VertexId(124)}), {1, 0, 0}};
             load.shares = {1.0};
             world.add_load({.name = "push", .kind = load});
         },
         "its shares must be empty"},
        {[] { physics::CustomLaw law(nullptr); }, "given as null"},
        {[&] { world.restore(""); }, "end too early"}};
    for (const auto& [misuse, why] : misuses) {
        const std::string message = input_error_of(misuse);
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
        EXPECT_TRUE(world.save() == before) << why;
    }
    session.run(20, Session::num_steps);
    Session undisturbed(held_world());
    undisturbed.run(0, Session::num_steps);
    EXPECT_TRUE(world.save() == undisturbed.world().save());
}

// An id from before a restore names the same tool as that of now: both in one step are refused.
TEST(World, RefusesInputsThatNameAToolTwice) {
    World world = held_world();
    const ToolId former = world.add_tool(scalpel());
    world.restore(world.save());
    const ToolId now = world.tools()[0];
    world.step(1e-5, StepInputs().move(former, scalpel_pose(0.0)));
    const auto twice = StepInputs().move(now, scalpel_pose(0.1)).withdraw(former);
    EXPECT_NE(input_error_of([&] { world.step(1e-5, twice); }).find("twice"), std::string::npos);
}

TEST(World, StepsThatAreRefusedLeaveNothingBehind) {
    struct Room {
        World world;
        ToolId ball, knife;
        ConstraintId hand;
    };
    const auto make_room = [] {
        Room room{held_world(), {}, {}, {}};
        World& world = room.world;
        room.ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{0.01}}});
        world.place_tool(room.ball, at({0.05, 0.05, size + 0.01}));
        room.knife = world.add_tool(scalpel());
        world.place_tool(room.knife, scalpel_pose(0.0));
        room.hand = world.grasp(
            "hand", nodes_where(world, [](const Vec3& x) { return x.z() == size && x.x() == 0.0; }),
            Pose());
        world.step(0.5 * world.stable_step());
        return room;
    };
    auto [world, ball, knife, hand] = make_room();
    World undisturbed = make_room().world;
    const std::string before = world.save();
    ASSERT_EQ(before, undisturbed.save());

    const double dt = 0.5 * world.stable_step();
    const StepInputs sound = StepInputs()
                                 .move(ball, at({0.05, 0.05, size + 0.005}))
                                 .move(knife, scalpel_pose(0.5))
                                 .withdraw(knife)
                                 .move(hand, at({0, 0, 0.001}));
    EXPECT_NO_THROW(world.require_possible(sound));
    const auto sound_and = [&](const auto& id, const Pose& pose) {
        return StepInputs(sound).move(id, pose);
    };
    struct Refused {
        const char* name;
        double dt;
        StepInputs inputs;
    };
    const std::vector<Refused> all = {
        {"a step back", -1.0, sound},
        {"too long a step", 100.0 * world.rest_stable_step(), sound},
        {"a tool that does not exist", dt, sound_and(ToolId{99}, Pose())},
        {"a pose that is not finite", dt, sound_and(ball, at({std::nan(""), 0, 0}))},
        {"a constraint that is no grasp", dt, sound_and(world.constraints()[0], Pose())},
        {"a probe that goes too far", dt, sound_and(ball, at({0.05, 0.05, 1000.0}))}};
    for (const auto& [name, step, inputs] : all) {
        SCOPED_TRACE(name);
        EXPECT_THROW(world.step(step, inputs), InputError);
        EXPECT_FALSE(world.has_failed());
        EXPECT_EQ(world.save(), before);
    }
    // Nothing of them takes part in the next step.
    world.step(dt);
    undisturbed.step(dt);
    EXPECT_EQ(world.save(), undisturbed.save());
}

TEST(World, RefusesIdsOfWhatItDoesNotHave) {
    World world(held_world()), other(held_world());
    const std::size_t num_constraints = world.constraints().size();
    const auto hold = [](World& in) {
        const auto top = nodes_where(in, [](const Vec3& x) { return x.z() == size; });
        return in.grasp("hand", top, Pose());
    };
    const auto add_plane = [](World& in) {
        return in.add_tool({"plane", cutting::PlaneCut{{0, 0, 0.5 * size}, Vec3::UnitZ()}});
    };
    // Another one has the place of what was removed.
    const ConstraintId removed = hold(world);
    world.release(removed);
    const ConstraintId hand = hold(world);
    EXPECT_EQ(hand.index, removed.index);
    EXPECT_NE(input_error_of([&] { world.release(removed); }).find("is no longer there"),
              std::string::npos);
    const std::string saved = world.save();
    // A restored world gives the place of what it has forgotten to others.
    const ToolId forgotten = add_plane(world);
    const LoadId forgotten_load = world.add_load(
        {.name = "push",
         .kind = physics::NodalLoad{physics::VertexSet(std::vector{VertexId(124)}), {1, 0, 0}}});
    world.restore(saved);
    const ToolId plane = add_plane(world);
    EXPECT_EQ(plane.index, forgotten.index);

    const ToolId plane_of_other = add_plane(other);
    const std::vector<std::pair<std::function<void()>, const char*>> misuses = {
        {[&] { world.require_possible(StepInputs().move(removed, Pose())); },
         "restored to a state without it"},
        {[&] { world.release(removed); }, "restored to a state without it"},
        {[&] { world.require_possible(StepInputs().move(forgotten, Pose())); },
         "restored to a state without it"},
        {[&] { world.set_load_factor(forgotten_load, 2.0); }, "restored to a state without it"},
        {[&] { world.require_possible(StepInputs().withdraw(plane_of_other)); },
         "of another world"},
        {[&] { other.release(hand); }, "of another world"},
        {[&] { world.require_possible(StepInputs().move(ToolId(), Pose())); }, "names no tool"}};
    for (const auto& [misuse, why] : misuses) {
        const std::string message = input_error_of(misuse);
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
    }
    // What is there is still named by the same ids, also in a world that was moved.
    World moved = std::move(world);
    moved.require_possible(StepInputs().move(hand, Pose()).move(plane, Pose()));
    EXPECT_EQ(moved.find_tool("plane"), plane);
    moved.release(hand);
    EXPECT_EQ(moved.constraints().size(), num_constraints);
    // Ids of a saved world name the same in another one that is restored to its state, but no more.
    other.restore(saved);
    other.require_possible(StepInputs().move(hand, Pose()));
    const ToolId only_there = add_plane(moved);
    add_plane(other);
    EXPECT_NE(input_error_of([&] {
                  other.require_possible(StepInputs().withdraw(only_there));
              }).find("of another world"),
              std::string::npos);
}

TEST(World, RefusesDefinitionsThatCannotBe) {
    const double nan = std::nan("");
    const auto links = [](WorldDef& def) -> physics::HyperElasticLinks& {
        return std::get<physics::HyperElasticLinks>(def.materials[0].method);
    };
    const auto data = [](WorldDef& def) -> topology::MeshData& {
        return std::get<topology::MeshData>(def.mesh);
    };
    const physics::VertexSet nowhere(std::vector{VertexId(100000)});
    using Spoil = std::function<void(WorldDef&)>;
    const std::vector<std::pair<Spoil, const char*>> faults = {
        {[](WorldDef& d) { d.precision = static_cast<physics::Precision>(9); },
         "no such precision"},
        {[](WorldDef& d) { d.fibres = {Vec3::UnitX()}; }, "one finite direction for each element"},
        {[&](WorldDef& d) { links(d).prony_rule = static_cast<physics::PronyRule>(7); },
         "no such rule"},
        {[](WorldDef& d) { d.materials.clear(); }, "has no material"},
        {[](WorldDef& d) { d.materials[0].density = -1060; }, "its density is -1060"},
        {[&](WorldDef& d) { d.materials[0].density = nan; }, "its density is"},
        {[&](WorldDef& d) {
             links(d).law = physics::NeoHookean{nan, 1.0};
         },
         "its shear modulus"},
        {[&](WorldDef& d) {
             links(d).law = physics::NeoHookean{200, -600};
         },
         "its bulk modulus"},
        {[&](WorldDef& d) { links(d).inversion_threshold = nan; }, "its inversion threshold"},
        {[&](WorldDef& d) {
             links(d).prony = {{1.2, 1.0}};
         },
         "add up to 1.2"},
        {[&](WorldDef& d) {
             links(d).prony = {{0.2, 0.0}};
         },
         "both must be above 0"},
        {[](WorldDef& d) { d.materials[0].method = physics::MassSprings{-1}; }, "Young's modulus"},
        {[](WorldDef& d) {
             d.material_of_region = {{0, 1}};
         },
         "region 0 has material 1"},
        {[](WorldDef& d) {
             d.material_of_region = {{7, 0}};
         },
         "region 0"},
        {[&](WorldDef& d) { d.gravity.x() = nan; }, "gravity is not finite"},
        {[](WorldDef& d) { d.damping = -5; }, "damping is -5"},
        {[](WorldDef& d) { d.solver = Solver(17); }, "no such solver"},
        {[](WorldDef& d) { d.num_threads = 0; }, "must be from 1 to 256"},
        {[](WorldDef& d) { d.num_threads = 257; }, "must be from 1 to 256"},
        {[&](WorldDef& d) { d.constraints = {{.name = "a", .nodes = nowhere}}; },
         "there is no node 100000"},
        {[](WorldDef& d) { d.constraints = {{}}; }, "it has no node"},
        {[&](WorldDef& d) { d.loads = {{.name = "a", .kind = physics::NodalLoad{nowhere}}}; },
         "there is no node 100000"},
        {[](WorldDef& d) { d.loads = {{}}; }, "it has no node"},
        {[&](WorldDef& d) { data(d).regions.clear(); }, "regions has 0 entries"},
        {[&](WorldDef& d) { data(d).offsets.pop_back(); }, "needs one more than cells"},
        {[&](WorldDef& d) { data(d).offsets.clear(); }, "needs one more than cells"},
        {[&](WorldDef& d) { data(d).offsets[2] = 1000000; }, "needs 4 corners"},
        {[&](WorldDef& d) { data(d).corners.pop_back(); }, "end with the number of corners"},
        {[&](WorldDef& d) { data(d).kinds[3] = topology::CellKind(77); }, "is of no kind"},
        {[&](WorldDef& d) { data(d).kinds[3] = topology::CellKind::hexahedron; },
         "needs 8 corners"},
        {[&](WorldDef& d) { data(d).welded_to = {0}; }, "welded_to has 1 entries"},
        {[&](WorldDef& d) { data(d).points[3].y() = nan; }, "is not finite"},
        {[](WorldDef& d) { d.mesh = topology::MeshData(); }, "a volume mesh is needed"}};
    for (const auto& [spoil, why] : faults) {
        WorldDef def = soft_body();
        spoil(def);
        const std::string message = input_error_of([&] { World{std::move(def)}; });
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
    }
}

TEST(World, RefusesShapesCurvesAndFactorsThatCannotBe) {
    World world = held_world();
    const std::string before = world.save();
    const double nan = std::nan("");
    const auto surface = [](std::vector<Vec3> points, std::array<std::int64_t, 3> triangle) {
        return cutting::SurfaceCut{{std::move(points), {triangle}}};
    };
    const std::vector<std::pair<cutting::ToolShape, const char*>> shapes = {
        {surface({{nan, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}), "is not finite"},
        {surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 77}), "names point 77"},
        {surface({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, -1, 2}), "names point -1"},
        {cutting::SurfaceCut{}, "has no triangle"},
        {cutting::PlaneCut{{nan, 0, 0}}, "its plane is not finite"},
        {cutting::PlaneCut{{0, 0, 0}, {nan, 0, 0}}, "its plane is not finite"},
        {cutting::PlaneCut{{0, 0, 0}, {1, 0, 0}, 7.0}, "a snap of 7"},
        {Blade{{{0, 0, 0}, {0, 0, 0}}}, "are the same"},
        {Blade{{{0, 0, 0}, {1, 0, 0}}, cutting::CutMode::split, nan}, "from 0 to 0.5"},
        {cutting::Carver{cutting::Capsule{{nan, 0, 0}, {0, 0, 0}, 1.0}}, "its axis"},
        {cutting::Carver{cutting::Cuboid{{1, 1, -1}}}, "it must be above 0"}};
    for (const auto& [shape, why] : shapes) {
        const std::string message = input_error_of([&, &held = shape] {
            world.add_tool({"odd", held});
        });
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
    }
    const physics::VertexSet top(nodes_where(world, [](const Vec3& x) { return x.z() == size; }));
    using Curve = physics::TimeCurve<Vec3>;
    const std::vector<std::pair<physics::Constraint, const char*>> constraints = {
        {{.name = "a", .nodes = top, .displacement = Curve({{0.0, Vec3(nan, 0, 0)}})},
         "not finite"},
        {{.name = "a",
          .nodes = top,
          .displacement = Curve({{1.0, Vec3::Zero()}, {0.5, Vec3::Zero()}})},
         "do not ascend"},
        {{.name = "a", .nodes = top, .components = {false, false, false}}, "no component"},
        {{.name = "a", .nodes = top, .axis = {0, 0, 2}}, "a length of 2"}};
    for (const auto& [constraint, why] : constraints) {
        const std::string message =
            input_error_of([&, &held = constraint] { world.add_constraint(held); });
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
    }
    EXPECT_NE(input_error_of([&] {
                  world.add_load({.name = "a",
                                  .kind = physics::NodalLoad{top, {1, 0, 0}},
                                  .factor = physics::TimeCurve<double>({{0.0, nan}})});
              }).find("not finite"),
              std::string::npos);
    EXPECT_NE(input_error_of([&] { world.set_num_threads(0); }).find("from 1 to 256"),
              std::string::npos);
    EXPECT_TRUE(world.save() == before);
}

TEST(World, RestoresOnlyWorldsOfItsSolverAndMaterials) {
    const std::string bytes = held_world().save();
    World implicit = held_world(Solver::implicit_euler), equilibria = held_world(Solver::statics);
    for (World* world : {&implicit, &equilibria})
        EXPECT_NE(input_error_of([&] { world->restore(bytes); }).find("another solver"),
                  std::string::npos);
    const auto refusal = [&](const std::function<void(WorldDef&)>& change) {
        WorldDef def = soft_body();
        change(def);
        World world(std::move(def));
        return input_error_of([&] { world.restore(bytes); });
    };
    EXPECT_EQ(refusal([](WorldDef&) {}), "");
    for (const auto& message :
         {refusal([](WorldDef& d) { d.materials[0].density = 1001; }),
          refusal([](WorldDef& d) { d.materials.push_back(d.materials[0]); }),
          refusal([](WorldDef& d) { d.precision = physics::Precision::single_precision; }),
          refusal([](WorldDef& d) {
              d.materials[0].method = physics::HyperElasticLinks{physics::NeoHookean{201, 600}};
          })})
        EXPECT_NE(message.find("other materials"), std::string::npos) << message;
}

}  // namespace
}  // namespace incise::sim
