// A world that is stepped from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <thread>

#include "incise/sim/selection.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "tests/runner/run_folder.h"

namespace incise::sim {
namespace {

using cutting::Blade;

constexpr double size = 0.1;  // of the cube, m

topology::MeshData cube(int cells = 4) {
    return topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), Vec3::Constant(size),
                              {cells, cells, cells});
}

WorldDef soft_body(Solver solver = Solver::semi_implicit_euler) {
    WorldDef def;
    def.mesh = cube();
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{200.0, 600.0}}}};
    def.gravity = {0, 0, -9.81};
    def.damping = 2.0;
    def.solver = solver;
    return def;
}

std::vector<NodeId> nodes_where(const World& world, const std::function<bool(const Vec3&)>& is_in) {
    std::vector<NodeId> nodes;
    for (const NodeId n : world.mesh().nodes())
        if (is_in(world.mesh().rest_position(n))) nodes.push_back(n);
    return nodes;
}

/// Held at its bottom.
World held_world(Solver solver = Solver::semi_implicit_euler) {
    World world(soft_body(solver));
    world.add_constraint({.name = "floor",
                          .nodes = physics::NodeSet(
                              nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }))});
    return world;
}

ToolDef scalpel() { return {"scalpel", Blade{{{0, -0.02, 0.051}, {0, 0.12, 0.053}}}}; }

Pose at(const Vec3& position) { return {Eigen::Quaterniond::Identity(), position}; }

/// Where the scalpel is after so much of its way through the cube.
Pose scalpel_pose(double part) { return at({-0.01 + 0.12 * part, 0, 0}); }

std::string input_error_of(const std::function<void()>& act) {
    try {
        act();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

/// Steps with a cut across the body, a grasp and a load that come and go.
class Session {
  public:
    explicit Session(World world) : world_(std::move(world)) {
        knife_ = world_.add_tool(scalpel());
    }

    void run(int from, int to) {
        for (int i = from; i < to; ++i) step(i);
    }
    World& world() { return world_; }

    static constexpr int num_steps = 60;

  private:
    void step(int i) {
        if (i == 5) world_.place_tool(knife_, scalpel_pose(0.0));
        if (i >= 5 && i < 35) world_.set_tool_pose(knife_, scalpel_pose((i - 4) / 30.0));
        if (i == 34) world_.withdraw_tool(knife_);
        if (i == 10)
            grasp_ = world_.grasp("hand",
                                  nodes_where(world_,
                                              [](const Vec3& x) {
                                                  return x.z() > 0.99 * size && x.x() < 0.3 * size;
                                              }),
                                  at({0, 0, size}));
        if (i >= 10 && i < 45) world_.set_grasp_pose(grasp_, at({0, 0, size + 2e-4 * (i - 9)}));
        if (i == 45) world_.release(grasp_);
        if (i == 20)
            load_ = world_.add_load({.name = "push",
                                     .kind = physics::NodalLoad{
                                         physics::NodeSet(nodes_where(
                                             world_, [](const Vec3& x) { return x.x() > 0.09; })),
                                         {1e-3, 0, 0}}});
        if (i == 30) world_.set_load_factor(load_, 0.5);
        if (i == 50) world_.remove_load(load_);
        world_.step(0.5 * world_.stable_step());
    }

    World world_;
    ToolId knife_{};
    ConstraintId grasp_{1};  // as numbers are given out: a restored session knows them too
    LoadId load_{0};
};

TEST(World, EqualsTheScenarioThatDrivesOne) {
    const auto scenario = runner::scenario_of(R"([mesh]
box = { size = [0.1, 0.1, 0.1], cells = [4, 4, 4] }
[[material]]
density = 1000
c1 = 200
lame_lambda = 600
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[tool]]
kind = "blade"
name = "scalpel"
edge = [[0, -0.02, 0.051], [0, 0.12, 0.053]]
path = [{ time = 0, at = [-0.01, 0, 0] }, { time = 0.05, at = [0.11, 0, 0] }]
)" + runner::dynamics(0.06, "gravity = [0, 0, -9.81]\ndamping = 2\n"));
    runner::Simulation run(scenario);
    World world = held_world();
    const ToolId tool_id = world.add_tool(scalpel());
    world.place_tool(tool_id, scalpel_pose(0.0));
    std::size_t num_edits = 0;
    while (!run.is_finished()) {
        run.step();
        if (world.is_tool_present(tool_id))
            world.set_tool_pose(tool_id, scalpel_pose(std::min(1.0, run.time() / 0.05)));
        if (run.time() >= 0.05 && world.is_tool_present(tool_id)) {
            const Pose before = scalpel_pose(0.999);
            world.withdraw_tool(tool_id, &before);
        }
        num_edits += world.step_to(run.time()).edits.size();
    }
    EXPECT_EQ(num_edits, run.edits().size());
    EXPECT_GE(num_edits, 3u);
    EXPECT_EQ(topology::components(world.mesh()).count, 2);
    ASSERT_EQ(world.mesh().num_nodes(), run.mesh().num_nodes());
    EXPECT_TRUE(std::ranges::equal(world.model().positions(), run.model().positions()));
    EXPECT_TRUE(std::ranges::equal(world.model().velocities(), run.model().velocities()));
}

TEST(World, ReportsEditsThatMakeTheSameMeshElsewhere) {
    Session session(held_world());
    topology::Mesh copy = topology::Mesh::build(cube()).mesh;
    topology::BoundarySurface surface(copy);
    session.world().surface();
    std::size_t num_edits = 0;
    for (int i = 0; i < Session::num_steps; ++i) {
        session.run(i, i + 1);
        const StepReport& report = session.world().report();
        EXPECT_EQ(report.to, session.world().time());
        for (const Edit& edit : report.edits) {
            topology::replay(copy, edit.changes);
            surface.apply(copy, edit.changes);
            EXPECT_EQ(edit.record.tool, "scalpel");
            EXPECT_EQ(edit.changes.elements_added.size(), edit.record.elements_added);
            ++num_edits;
        }
    }
    EXPECT_GE(num_edits, 5u);
    EXPECT_EQ(topology::validate(copy), std::vector<std::string>{});
    EXPECT_EQ(copy.epoch(), session.world().mesh().epoch());
    EXPECT_TRUE(std::ranges::equal(surface.triangles(), session.world().surface().triangles()));
    EXPECT_GT(std::ranges::count(surface.is_cut(), 1), 20);
    EXPECT_LT(session.world().ledger().mass_error(), 1e-12);
}

TEST(World, GoesOnFromSavedBytesToTheSameBits) {
    for (const Solver solver : {Solver::semi_implicit_euler, Solver::implicit_euler}) {
        Session whole(held_world(solver));
        std::vector<std::string> moments;
        for (int i = 0; i < Session::num_steps; ++i) {
            if (i % 6 == 0 || i == 34 || i == 35) moments.push_back(whole.world().save());
            whole.run(i, i + 1);
        }
        const std::string end = whole.world().save();
        int next = 0;
        for (int i = 0; i < Session::num_steps; ++i) {
            if (i % 6 != 0 && i != 34 && i != 35) continue;
            SCOPED_TRACE(i);
            // In a fresh world, and in one that has gone on already.
            const std::string& bytes = moments[static_cast<std::size_t>(next++)];
            Session fresh(held_world(solver));
            fresh.world().restore(bytes);
            ASSERT_TRUE(fresh.world().save() == bytes);
            fresh.run(i, Session::num_steps);
            EXPECT_TRUE(fresh.world().save() == end);
            if (i % 12 != 0) continue;
            whole.world().restore(bytes);
            EXPECT_EQ(topology::validate(whole.world().mesh()), std::vector<std::string>{});
            whole.run(i, Session::num_steps);
            EXPECT_TRUE(whole.world().save() == end);
        }
    }
}

TEST(World, RefusesDamagedBytesAndStaysAsItWas) {
    Session session(held_world());
    session.run(0, 25);
    const std::string good = session.world().save();
    test::Random random(5);
    int num_refused = 0;
    for (int i = 0; i < test::num_cases(300); ++i) {
        SCOPED_TRACE(i);
        std::string bytes = good;
        const std::size_t place = random.below(bytes.size() - 8);
        if (random.below(3) == 0)
            bytes.erase(place, 1 + random.below(16));
        else
            bytes.replace(place, 4, bytes.substr(random.below(bytes.size() - 4), 4));
        if (!input_error_of([&] { session.world().restore(bytes); }).empty()) {
            ++num_refused;
            EXPECT_TRUE(session.world().save() == good);
        } else {
            session.world().restore(good);
        }
    }
    EXPECT_GT(num_refused, test::num_cases(100));
    EXPECT_EQ(input_error_of([&] { session.world().restore("rubbish and more"); }),
              "this is no saved world");
}

TEST(World, CanBeMovedAndSteppedInThreads) {
    Session alone(held_world());
    alone.run(0, Session::num_steps);
    const std::string end = alone.world().save();
    constexpr int num_worlds = 3;
    std::vector<std::string> ends(num_worlds);
    std::vector<std::thread> threads;
    for (std::string& result : ends)
        threads.emplace_back([&result] {
            Session session(held_world());
            session.run(0, 20);
            World moved = std::move(session.world());
            session.world() = std::move(moved);
            session.run(20, Session::num_steps);
            result = session.world().save();
        });
    for (std::thread& thread : threads) thread.join();
    for (const std::string& result : ends) EXPECT_TRUE(result == end);
}

TEST(World, GraspHoldsDeformedTissueAndCarriesIt) {
    World world = held_world();
    while (world.time() < 0.05) world.step(0.5 * world.stable_step());
    const auto top = nodes_where(world, [](const Vec3& x) { return x.z() == size; });
    std::vector<Vec3> before;
    for (const NodeId n : top) before.push_back(world.model().positions()[n.index()]);
    const Pose start = at({0.05, 0.05, size});
    const ConstraintId hand = world.grasp("hand", top, start);
    const Pose end{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitZ())),
                   start.position + Vec3(0, 0, 0.01)};
    constexpr int num_steps = 50;
    for (int i = 1; i <= num_steps; ++i) {
        world.set_grasp_pose(hand, interpolate(start, end, double(i) / num_steps));
        world.step(0.5 * world.stable_step());
    }
    for (std::size_t i = 0; i < top.size(); ++i) {
        const Vec3 there = end.to_world(start.to_tool(before[i]));
        EXPECT_LE((world.model().positions()[top[i].index()] - there).norm(), 1e-15);
    }
    EXPECT_GT(world.reaction(hand).force.norm(), 0.0);
    world.release(hand);
    world.step(0.5 * world.stable_step());
    EXPECT_NE(input_error_of([&] { world.reaction(hand); }).find("has been removed"),
              std::string::npos);
}

TEST(World, LoadsActFromTheStepInWhichTheyCome) {
    WorldDef def = soft_body();
    def.gravity = Vec3::Zero();
    def.damping = 0.0;
    World world(std::move(def));
    const double dt = 0.5 * world.stable_step(), mass = 1.0;  // 1000 kg/m3 in a litre
    const auto all = nodes_where(world, [](const Vec3&) { return true; });
    const double share = 1.0 / static_cast<double>(all.size());
    const auto momentum = [&] { return world.model().totals().momentum.x(); };
    world.step(dt);
    EXPECT_NEAR(momentum(), 0.0, 1e-20);
    const LoadId load = world.add_load(
        {.name = "push", .kind = physics::NodalLoad{physics::NodeSet(all), {2.0 * share, 0, 0}}});
    world.step(dt);
    EXPECT_NEAR(momentum(), 2.0 * dt, 1e-12 * mass);
    world.set_load_factor(load, -0.5);
    world.step(dt);
    EXPECT_NEAR(momentum(), 1.0 * dt, 1e-12 * mass);
    world.remove_load(load);
    world.step(dt);
    EXPECT_NEAR(momentum(), 1.0 * dt, 1e-12 * mass);
}

TEST(World, MisuseIsRefusedAndChangesNothing) {
    Session session(held_world());
    session.run(0, 20);
    World& world = session.world();
    const std::string before = world.save();
    const double nan = std::nan(""), bound = world.stable_step();
    const physics::NodeSet floor(nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }));
    const std::vector<std::pair<std::function<void()>, const char*>> misuses = {
        {[&] { world.step(0.0); }, "it must be above 0"},
        {[&] { world.step(-1e-3); }, "it must be above 0"},
        {[&] { world.step(nan); }, "it must be above 0"},
        {[&] { world.step(1.01 * bound); }, "is above the stable step of"},
        {[&] { world.step_to(world.time()); }, "it must go forward"},
        {[&] { world.set_tool_pose({7}, {}); }, "there is no tool 7"},
        {[&] { world.withdraw_tool({3}); }, "there is no tool 3"},
        {[&] { world.place_tool({0}, {}); }, "withdraw it before it is put elsewhere"},
        {[&] {
             world.set_tool_pose({0}, at({nan, 0, 0}));
         },
         "its pose must have"},
        {[&] {
             world.set_tool_pose({0}, {Eigen::Quaterniond(2, 0, 0, 0), Vec3::Zero()});
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
             world.add_tool({"plane", cutting::PlaneCut{{}, Vec3::Zero()}});
         },
         "the normal of its plane is zero"},
        {[&] { world.add_constraint({.name = "more", .nodes = floor}); },
         "is held in x by both 'floor' and 'more'"},
        {[&] { world.add_constraint({.name = "none"}); }, "it has no node"},
        {[&] { world.grasp("hand", {NodeId(99999)}, {}); }, "there is no node 99999"},
        {[&] { world.set_grasp_pose({0}, {}); }, "is no grasp"},
        {[&] { world.set_grasp_pose({9}, {}); }, "there is no constraint 9"},
        {[&] { world.release({9}); }, "there is no constraint 9"},
        {[&] { world.remove_load({4}); }, "there is no load 4"},
        {[&] {
             world.add_load(
                 {.name = "wind", .kind = physics::TractionLoad{{{{ElementId(3), 9}}}, {}}});
         },
         "is not on the surface"},
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

TEST(World, RefusesDefinitionsThatCannotBe) {
    const double nan = std::nan("");
    const auto links = [](WorldDef& def) -> physics::HyperElasticLinks& {
        return std::get<physics::HyperElasticLinks>(def.materials[0].method);
    };
    const auto data = [](WorldDef& def) -> topology::MeshData& {
        return std::get<topology::MeshData>(def.mesh);
    };
    const physics::NodeSet nowhere(std::vector{NodeId(100000)});
    using Spoil = std::function<void(WorldDef&)>;
    const std::vector<std::pair<Spoil, const char*>> faults = {
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
        {[](WorldDef& d) { d.num_threads = 0; }, "must be at least 1"},
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
        {Blade{{{0, 0, 0}, {1, 0, 0}}, cutting::CutMode::split, nan}, "from 0 to 1"},
        {cutting::Carver{cutting::Capsule{{nan, 0, 0}, {0, 0, 0}, 1.0}}, "its axis"},
        {cutting::Carver{cutting::Cuboid{{1, 1, -1}}}, "it must be above 0"}};
    for (const auto& [shape, why] : shapes) {
        const std::string message = input_error_of([&, &held = shape] {
            world.add_tool({"odd", held});
        });
        EXPECT_NE(message.find(why), std::string::npos) << message << " for " << why;
    }
    const physics::NodeSet top(nodes_where(world, [](const Vec3& x) { return x.z() == size; }));
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
    EXPECT_NE(input_error_of([&] { world.set_num_threads(0); }).find("at least 1"),
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

TEST(World, ThatHasFailedIsNotSteppedAndCanBeRestored) {
    World world = held_world();
    const double dt = 0.5 * world.stable_step();
    world.step(dt);
    const std::string before = world.save();
    world.add_load(
        {.name = "blast",
         .kind = physics::NodalLoad{
             physics::NodeSet(nodes_where(world, [](const Vec3& x) { return x.z() > 0.09; })),
             {0, 0, 1e12}}});
    EXPECT_THROW(world.step(dt), PhysicsError);
    EXPECT_TRUE(world.has_failed());
    EXPECT_NE(input_error_of([&] { world.step(dt); }).find("has failed"), std::string::npos);
    world.restore(world.save());
    EXPECT_TRUE(world.has_failed());
    world.restore(before);
    EXPECT_FALSE(world.has_failed());
    world.step(dt);
    World other = held_world();
    other.step(dt);
    other.step(dt);
    EXPECT_TRUE(world.save() == other.save());
}

TEST(World, TellsWhatAToolCannotDivide) {
    WorldDef def;
    def.mesh = topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                  Vec3::Constant(size), {2, 2, 2});
    def.materials = {{1000.0, physics::HybridSprings{400.0, 400.0}}};
    World world(std::move(def));
    const ToolId tool_id = world.add_tool(scalpel());
    world.place_tool(tool_id, scalpel_pose(0.0));
    world.set_tool_pose(tool_id, scalpel_pose(0.5));
    try {
        world.step(0.5 * world.stable_step());
        FAIL() << "it has been divided";
    } catch (const ToolError& error) {
        EXPECT_EQ(error.tool, tool_id);
        EXPECT_TRUE(error.is_undividable);
        EXPECT_EQ(std::string(error.what()).find("mode ="), std::string::npos);
    }
}

}  // namespace
}  // namespace incise::sim
