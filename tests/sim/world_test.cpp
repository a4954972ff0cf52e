// A world that is stepped from outside.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/world.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <thread>

#include "incise/sim/selection.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh_edit.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "support/num_cases.h"
#include "tests/runner/run_folder.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

/// A body of held_world(), and a tool on a path of two keys that turns on its way.
struct ScriptedCut {
    const char* name;
    Solver solver;
    ToolDef tool;
    const char* keys;  // of the tool, in the scenario
    double angle;      // rad about x, at the end of the path
    double step;       // s; 0: automatic
};

std::vector<ScriptedCut> scripted_cuts() {
    const ToolDef burr{"tool", cutting::Carver{cutting::Cuboid{{0.03, 0.12, 0.03}}}};
    const char *edge = "kind = \"blade\"\nedge = [[0, -0.02, 0.051], [0, 0.12, 0.053]]\n",
               *box = "kind = \"carver\"\nshape = { box = { size = [0.03, 0.12, 0.03] } }\n";
    const ToolDef blade{"tool", std::get<Blade>(scalpel().shape)};
    return {{"straight blade", Solver::semi_implicit_euler, blade, edge, 0.0, 0.0},
            {"turning blade", Solver::semi_implicit_euler, blade, edge, 0.2, 0.0},
            {"turning carver", Solver::semi_implicit_euler, burr, box, 0.7, 0.0},
            {"implicit steps", Solver::implicit_euler, blade, edge, 0.1, 0.005}};
}

TEST(World, EqualsTheScenarioThatDrivesOne) {
    for (const ScriptedCut& cut : scripted_cuts()) {
        SCOPED_TRACE(cut.name);
        const bool is_implicit = cut.solver == Solver::implicit_euler;
        const auto scenario = runner::scenario_of(
            R"([mesh]
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
name = "tool"
path = [{ time = 0, at = [-0.01, 0, 0] },
        { time = 0.05, at = [0.11, 0, 0], rotate = { axis = [1, 0, 0], angle = )" +
            std::to_string(cut.angle) + " } }]\n" + cut.keys +
            runner::dynamics(0.06, "gravity = [0, 0, -9.81]\ndamping = 2\n") +
            (is_implicit ? "integrator = \"implicit-euler\"\ntime_step = 0.005\n" : ""));
        runner::Simulation run(scenario);
        World world = held_world(cut.solver);
        const Pose start = at({-0.01, 0, 0});
        const Pose end{Eigen::Quaterniond(Eigen::AngleAxisd(cut.angle, Vec3::UnitX())),
                       {0.11, 0, 0}};
        const ToolId tool = world.add_tool(cut.tool);
        world.place_tool(tool, start);
        std::size_t num_edits = 0;
        while (!run.is_finished()) {
            run.step();
            StepInputs inputs;
            if (world.is_tool_present(tool))
                inputs.move(tool, interpolate(start, end, std::min(1.0, run.time() / 0.05)));
            if (run.time() >= 0.05 && world.is_tool_present(tool)) {
                const Pose before = interpolate(start, end, 0.999);
                inputs.withdraw(tool, &before);
            }
            num_edits += world.step_to(run.time(), inputs).edits.size();
        }
        EXPECT_EQ(num_edits, run.edits().size());
        EXPECT_GE(num_edits, 3u);
        EXPECT_EQ(topology::to_mesh_data(world.mesh(), world.positions()).corners,
                  topology::to_mesh_data(run.mesh(), run.model().mesh_positions()).corners);
        EXPECT_TRUE(std::ranges::equal(world.model().positions(), run.model().positions()));
        EXPECT_TRUE(std::ranges::equal(world.model().velocities(), run.model().velocities()));
    }
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
            topology::replay(copy, edit.body.material);
            surface.apply(copy, edit.body.material);
            EXPECT_EQ(edit.record.tool, "scalpel");
            EXPECT_EQ(edit.body.material.elements_added.size(), edit.record.elements_added);
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

TEST(World, ResumesFromSavedBytesToTheBit) {
    for (const auto& [name, body, mode] : resumable_cuts()) {
        SCOPED_TRACE(name);
        const auto session = [&] { return Session(held(World(body())), scalpel(mode)); };
        Session whole = session();
        std::vector<std::string> moments;
        for (int i = 0; i < Session::num_steps; ++i) {
            if (i % 6 == 0 || i == 34 || i == 35) moments.push_back(whole.world().save());
            whole.run(i, i + 1);
        }
        EXPECT_GE(topology::components(whole.world().mesh()).count, 2);  // and chips
        const std::string end = whole.world().save();
        int next = 0;
        for (int i = 0; i < Session::num_steps; ++i) {
            if (i % 6 != 0 && i != 34 && i != 35) continue;
            SCOPED_TRACE(i);
            // In a fresh world, and in one that has gone on already.
            const std::string& bytes = moments[static_cast<std::size_t>(next++)];
            Session fresh = session();
            fresh.restore(bytes);
            ASSERT_TRUE(fresh.world().save() == bytes);
            fresh.run(i, Session::num_steps);
            EXPECT_TRUE(fresh.world().save() == end);
            if (i % 12 != 0) continue;
            whole.restore(bytes);
            EXPECT_EQ(topology::validate(whole.world().mesh()), std::vector<std::string>{});
            whole.run(i, Session::num_steps);
            EXPECT_TRUE(whole.world().save() == end);
        }
    }
}

TEST(World, ResumesStaticsFromSavedBytesToTheBit) {
    const auto step = [](World& world, int i) {
        StepInputs inputs;
        if (i == 1)
            world.add_load({.name = "push",
                            .kind = physics::NodalLoad{
                                physics::VertexSet(nodes_where(
                                    world, [](const Vec3& x) { return x.z() == size; })),
                                {1e-3, 0, 0}}});
        if (i == 3) {
            const ToolId burr = world.add_tool({"burr", cutting::Carver{cutting::Sphere{0.02}}});
            world.place_tool(burr, at({0.5 * size, 0.5 * size, 2 * size}));
            inputs.move(burr, at({0.5 * size, 0.5 * size, 0.03})).withdraw(burr);
        }
        world.step(0.1, inputs);
    };
    World whole = held_world(Solver::statics);
    std::vector<std::string> moments;
    for (int i = 0; i < 6; ++i) {
        moments.push_back(whole.save());
        step(whole, i);
    }
    EXPECT_GT(whole.ledger().num_edits(), 0u);
    const std::string end = whole.save();
    for (int i = 0; i < 6; ++i) {
        World fresh = held_world(Solver::statics);
        fresh.restore(moments[static_cast<std::size_t>(i)]);
        for (int k = i; k < 6; ++k) step(fresh, k);
        EXPECT_TRUE(fresh.save() == end) << i;
    }
}

TEST(World, RefusesDamagedBytesAndStaysAsItWas) {
    for (const auto& [name, body, mode] : resumable_cuts()) {
        Session session(held(World(body())), scalpel(mode));
        session.run(0, 25);
        const std::string good = session.world().save();
        test::Random random(5);
        const int num_cases = test::num_cases(100);
        int num_refused = 0;
        for (int i = 0; i < num_cases; ++i) {
            SCOPED_TRACE(name + std::string(" ") + std::to_string(i));
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
        EXPECT_GT(num_refused, num_cases / 3);
        EXPECT_EQ(input_error_of([&] { session.world().restore("rubbish and more"); }),
                  "this is no saved world");
    }
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
            session.world().set_num_threads(2);
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
    for (const VertexId n : top) before.push_back(world.model().positions()[n.index()]);
    const Pose start = at({0.05, 0.05, size});
    const ConstraintId hand = world.grasp("hand", top, start);
    const Pose end{Eigen::Quaterniond(Eigen::AngleAxisd(0.3, Vec3::UnitZ())),
                   start.position + Vec3(0, 0, 0.01)};
    constexpr int num_steps = 50;
    for (int i = 1; i <= num_steps; ++i) {
        const Pose pose = interpolate(start, end, double(i) / num_steps);
        world.step(0.5 * world.stable_step(), StepInputs().move(hand, pose));
    }
    for (std::size_t i = 0; i < top.size(); ++i) {
        const Vec3 there = end.to_world(start.to_tool(before[i]));
        EXPECT_LE((world.model().positions()[top[i].index()] - there).norm(), 1e-15);
    }
    EXPECT_GT(world.reaction(hand).force.norm(), 0.0);
    world.release(hand);
    world.step(0.5 * world.stable_step());
    EXPECT_NE(input_error_of([&] { world.reaction(hand); }).find("is no longer there"),
              std::string::npos);
}

// Nodes of a cut near a clamp depend on corners that the clamp holds. The clamp keeps these.
TEST(World, GraspHoldsTissueBesideAClamp) {
    World world = held_world();
    const ToolId plane =
        world.add_tool({"plane", cutting::PlaneCut{{0.05, 0.05, 0.012}, {0.02, 0.01, 1}}});
    world.step(0.5 * world.stable_step(), StepInputs().move(plane, Pose()).withdraw(plane));
    const auto grasped =
        nodes_where(world, [](const Vec3& x) { return x.z() > 0.005 && x.z() < 0.02; });
    ASSERT_FALSE(grasped.empty());
    const ConstraintId hand = world.grasp("hand", grasped, Pose());
    for (int i = 0; i < 5; ++i)
        world.step(0.5 * world.stable_step(), StepInputs().move(hand, at({0, 0, 1e-4 * i})));
    const auto positions = world.positions();
    for (const VertexId n : nodes_where(world, [](const Vec3& x) { return x.z() == 0.0; }))
        EXPECT_EQ(positions[n.index()], world.mesh().rest_position(n));
    EXPECT_GT(world.reaction(hand).force.norm(), 0.0);
}

TEST(World, LoadsActFromTheirFirstStep) {
    WorldDef def = soft_body();
    def.gravity = Vec3::Zero();
    def.damping = 0.0;
    World world(std::move(def));
    const double dt = 0.5 * world.stable_step(), mass = 1.0;  // 1000 kg/m3 in a litre
    const auto all = nodes_where(world, [](const Vec3&) { return true; });
    const double share = 1.0 / static_cast<double>(all.size());
    const auto momentum = [&] { return world.model().energetics().totals().momentum.x(); };
    world.step(dt);
    EXPECT_NEAR(momentum(), 0.0, 1e-20);
    const LoadId load = world.add_load(
        {.name = "push", .kind = physics::NodalLoad{physics::VertexSet(all), {2.0 * share, 0, 0}}});
    world.step(dt);
    EXPECT_NEAR(momentum(), 2.0 * dt, 1e-12 * mass);
    world.set_load_factor(load, -0.5);
    world.step(dt);
    EXPECT_NEAR(momentum(), 1.0 * dt, 1e-12 * mass);
    world.remove_load(load);
    world.step(dt);
    EXPECT_NEAR(momentum(), 1.0 * dt, 1e-12 * mass);
}

/// Springs from all nodes to where they are at rest.
class Tethers : public physics::ForceTerm {
  public:
    void update(const physics::BodyView& body) override { num_nodes = body.mesh.num_nodes(); }
    void add_forces(const physics::BodyView& body, physics::NodeRange range,
                    std::span<const Vec3> positions, double,
                    std::span<Vec3> forces) const override {
        for (std::size_t n = range.begin; n < range.end; ++n)
            if (body.masses[n] > 0.0)
                forces[n] += stiffness * (body.mesh.rest_position(VertexId(n)) - positions[n]);
    }
    double stiffness_bound(NodeId) const override { return stiffness; }
    void apply(const physics::BodyView&, const physics::BodyEdit&) override { ++num_edits; }

    static constexpr double stiffness = 2.0;  // N/m
    std::size_t num_edits = 0, num_nodes = 0;
};

TEST(World, ForceTermsActFollowEditsAndOutliveRestore) {
    const auto tethered = [](const Tethers** seen = nullptr) {
        World world = held_world();
        const double bound = world.stable_step();
        auto term = std::make_unique<Tethers>();
        if (seen) *seen = term.get();
        world.add_force_term(std::move(term));
        EXPECT_LT(world.stable_step(), bound);
        return world;
    };
    const Tethers* term = nullptr;
    Session session(tethered(&term)), without(held_world());
    session.run(0, 25);
    without.run(0, 25);
    EXPECT_GT(term->num_edits, 0u);
    const std::string bytes = session.world().save();
    EXPECT_FALSE(bytes == without.world().save());
    const std::size_t num_nodes = session.world().mesh().num_nodes();
    session.run(25, Session::num_steps);
    const std::string end = session.world().save();
    session.restore(bytes);
    EXPECT_EQ(term->num_nodes, num_nodes);
    session.run(25, Session::num_steps);
    EXPECT_TRUE(session.world().save() == end);
    Session fresh(tethered());
    fresh.restore(bytes);
    fresh.run(25, Session::num_steps);
    EXPECT_TRUE(fresh.world().save() == end);
}

TEST(World, RefusesForceTermsThatCannotBe) {
    class Odd : public Tethers {
      public:
        explicit Odd(double bound) : bound_(bound) {}
        double stiffness_bound(NodeId) const override { return bound_; }
        void update(const physics::BodyView& body) override {
            if (has_to_throw) throw InputError("not this body");
            Tethers::update(body);
        }
        bool has_to_throw = false;

      private:
        double bound_;
    };
    Session session(held_world());
    World& world = session.world();
    const std::string before = world.save();
    const double bound = world.rest_stable_step();
    EXPECT_NE(input_error_of([&] { world.add_force_term(nullptr); }), "");
    for (const double odd : {-1e9, std::nan(""), std::numeric_limits<double>::infinity()}) {
        EXPECT_NE(input_error_of([&] { world.add_force_term(std::make_unique<Odd>(odd)); }), "");
        EXPECT_EQ(world.rest_stable_step(), bound);
    }
    auto owned = std::make_unique<Odd>(2.0);
    Odd* term = owned.get();
    world.add_force_term(std::move(owned));
    EXPECT_LT(world.rest_stable_step(), bound);
    // A restore that the term refuses leaves the term with the world.
    term->has_to_throw = true;
    EXPECT_EQ(input_error_of([&] { world.restore(before); }), "not this body");
    term->has_to_throw = false;
    session.run(0, 5);
    const physics::ForceTerm* stranger = nullptr;
    EXPECT_NE(input_error_of([&] { world.remove_force_term(stranger); }), "");
    world.remove_force_term(term);
    EXPECT_EQ(world.rest_stable_step(), bound);
    world.restore(before);
    session.run(0, 10);
    Session undisturbed(held_world());
    undisturbed.run(0, 10);
    EXPECT_TRUE(world.save() == undisturbed.world().save());
}

TEST(World, PlacesAToolThatWasWithdrawn) {
    World world = held_world();
    const ToolId tool = world.add_tool(scalpel());
    world.place_tool(tool, at({-0.05, 0, 0}));
    world.step(0.5 * world.stable_step(), StepInputs().withdraw(tool));
    EXPECT_FALSE(world.is_tool_present(tool));
    world.place_tool(tool, at({-0.04, 0, 0}));
    world.step(0.5 * world.stable_step());
    EXPECT_TRUE(world.is_tool_present(tool));
}

// There the difference of two times is no longer the step that was asked for.
TEST(World, StepsAtTheBoundFarFromTimeZero) {
    World world = held_world();
    const double dt = 0.9 * world.stable_step(), late = 1e5;
    world.step(dt);
    std::string bytes = world.save();
    const auto text_of = [](double x) {
        return std::string(reinterpret_cast<const char*>(&x), sizeof x);
    };
    const std::size_t place = bytes.find(text_of(world.time()));
    ASSERT_NE(place, std::string::npos);
    bytes.replace(place, sizeof late, text_of(late));
    world.restore(bytes);
    ASSERT_EQ(world.time(), late);
    for (int i = 0; i < 5; ++i) world.step(world.stable_step());
    EXPECT_GT(world.time(), late);
}

TEST(World, RefusesStepsAfterFailureUntilRestored) {
    World world = held_world();
    const double dt = 0.5 * world.stable_step();
    world.step(dt);
    const std::string before = world.save();
    world.add_load(
        {.name = "blast",
         .kind = physics::NodalLoad{
             physics::VertexSet(nodes_where(world, [](const Vec3& x) { return x.z() > 0.09; })),
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

}  // namespace
}  // namespace incise::sim
