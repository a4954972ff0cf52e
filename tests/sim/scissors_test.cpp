// Scissors cut what is between their blades while they close, wherever steps end.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <ostream>
#include <string>
#include <utility>
#include <vector>

#include "incise/sim/undo_point.h"
#include "incise/sim/world.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/validate.h"
#include "support/mesh_families.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

using cutting::Scissors;
using ::testing::HasSubstr;

constexpr double spacing = 0.005;  // of the mesh, m
const Vec3 strip_size{0.04, 0.02, 0.01};

/// A strip at rest, and scissors across it.
struct Snip {
    Solver solver = Solver::implicit_euler;
    double x = 0.0175;    ///< of the plane of the scissors, m
    double z = 0.005;     ///< of their axis, m
    double jitter = 0.0;  ///< of the inner nodes, as a share of the spacing
    double snap = cutting::default_snap;
    int num_steps = 7;     ///< while they close
    double length = 0.06;  ///< of the blades, from y = -0.01 on, m
    double scale = 1.0;    ///< of the strip and of all lengths here
    double angle = 1.6;    ///< rad

    friend std::ostream& operator<<(std::ostream& out, const Snip& s) {
        return out << "solver " << static_cast<int>(s.solver) << ", x " << s.x << ", z " << s.z
                   << ", jitter " << s.jitter << ", snap " << s.snap << ", steps " << s.num_steps
                   << ", length " << s.length << ", angle " << s.angle << ", scale " << s.scale;
    }
};

World strip(const Snip& s) {
    WorldDef def;
    topology::MeshData mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(), strip_size, {8, 4, 2});
    test::Random random(7);
    for (Vec3& x : mesh.points)
        for (int k = 0; k < 3; ++k)
            if (x[k] > 1e-9 && x[k] < strip_size[k] - 1e-9)
                x[k] += s.jitter * spacing * random.uniform(-0.5, 0.5);
    for (Vec3& x : mesh.points) x *= s.scale;
    def.mesh = std::move(mesh);
    def.materials = {{1000.0, physics::HyperElasticLinks{physics::NeoHookean{2e3, 6e3}}}};
    def.damping = 2.0;
    def.solver = s.solver;
    World world(std::move(def));
    world.add_constraint(
        {.name = "ends", .nodes = physics::VertexSet(nodes_where(world, [&](const Vec3& x) {
                             return x.x() == 0.0 || x.x() == s.scale * strip_size.x();
                         }))});
    return world;
}

/// The pose of scissors that point along y, and whose blades open along z.
Pose across_strip(const Snip& s) {
    Eigen::Matrix3d rotation;
    rotation.col(0) = Vec3::UnitZ();
    rotation.col(1) = -Vec3::UnitX();
    rotation.col(2) = -Vec3::UnitY();
    return {Eigen::Quaterniond(rotation).normalized(), s.scale * Vec3(s.x, -0.01, s.z)};
}

double step_of(const World& world, const Snip& s) {
    return s.solver == Solver::semi_implicit_euler ? 0.5 * world.stable_step() : 0.01;
}

ToolId add_scissors(World& world, const Snip& s) {
    const double closing_time = s.num_steps * step_of(world, s);
    const ToolId tool =
        world.add_tool({"scissors", Scissors{s.scale * s.length, s.angle, closing_time, s.snap}});
    world.place_tool(tool, across_strip(s));
    return tool;
}

struct Outcome {
    double area = 0.0;  ///< opened, m2
    std::size_t num_edits = 0;
};

/// @param inputs  of the first step
void step(World& world, const Snip& s, int num_steps, Outcome& sum, StepInputs inputs = {}) {
    for (int i = 0; i < num_steps; ++i, inputs.clear()) {
        for (const Edit& edit : world.step(step_of(world, s), inputs).edits) {
            sum.area += edit.record.cut_area;
            ++sum.num_edits;
        }
        ASSERT_EQ(topology::validate(world.mesh()), std::vector<std::string>{});
    }
}

/// Closes the scissors, and goes on for two steps.
Outcome close(World& world, const Snip& s, ToolId tool) {
    Outcome done;
    world.close_tool(tool);
    step(world, s, s.num_steps + 2, done);
    return done;
}

// With planes of the mesh at the cut, along the axis, and at the ends of steps.
TEST(Scissors, PartAStripInAnyNumberOfSteps) {
    for (const Solver solver :
         {Solver::semi_implicit_euler, Solver::implicit_euler, Solver::statics})
        for (const double x : {0.0175, 0.02, 0.0213})
            for (const double z : {0.005, 0.0046})
                for (const auto& [num_steps, length] :
                     {std::pair{1, 0.06}, std::pair{7, 0.06}, std::pair{8, 0.07}})
                    for (const double jitter : {0.0, 0.3}) {
                        Snip s{.solver = solver, .x = x, .z = z, .jitter = jitter};
                        s.num_steps = num_steps;
                        s.length = length;
                        SCOPED_TRACE(testing::PrintToString(s));
                        World world = strip(s);
                        const ToolId tool = add_scissors(world, s);
                        const Outcome done = close(world, s, tool);
                        EXPECT_EQ(topology::components(world.mesh()).count, 2);
                        EXPECT_NEAR(done.area, 0.02 * 0.01, 0.02 * 0.02 * 0.01);
                        EXPECT_FALSE(world.report().tools.at(0).is_in_tissue);
                        EXPECT_LT(world.ledger().mass_error(), 1e-13);
                    }
}

// Steps that end exactly where the line of the blades is in a plane of the mesh.
TEST(Scissors, MayStopInPlanesOfTheMesh) {
    Snip s;
    // The line goes from 0.02 to 1 of the depth, in steps of two spacings.
    const double depth = 4.0 * 2.0 * spacing / 0.98;
    s.length = depth / std::cos(0.5 * s.angle);
    s.num_steps = 4;
    for (const double shift : {0.0, 0.25, 0.5, 0.75})
        for (const double x : {0.0175, 0.02})
            for (const double snap : {0.0, cutting::default_snap}) {
                s.x = x;
                s.snap = snap;
                SCOPED_TRACE(testing::PrintToString(s) + ", shift " + std::to_string(shift));
                World world = strip(s);
                const ToolId tool = add_scissors(world, s);
                Pose pose = across_strip(s);
                pose.position.y() = -0.01 + (shift - 0.02 * depth / spacing) * spacing;
                world.place_tool(tool, pose);
                close(world, s, tool);
                EXPECT_EQ(topology::components(world.mesh()).count, 2);
            }
}

// Blades that are too short leave the far side joined. The area is that of the triangle between
// them, as far as it is in the strip. Its sides and its end are exact to an element each.
TEST(Scissors, CutNoMoreThanIsBetweenThem) {
    for (const auto& [length, angle] :
         {std::pair{0.02, 0.5}, std::pair{0.025, 0.5}, std::pair{0.03, 1.6}, std::pair{0.036, 1.6}})
        for (const double scale : {1.0, 10.0}) {
            Snip s{.x = 0.0176, .z = 0.0052};
            s.length = length;
            s.angle = angle;
            s.scale = scale;
            SCOPED_TRACE(testing::PrintToString(s));
            World world = strip(s);
            const Outcome done = close(world, s, add_scissors(world, s));
            EXPECT_EQ(topology::components(world.mesh()).count, 1);
            double between = 0.0, rim = 0.0;
            constexpr double part = 1e-5;
            for (double t = 0.01; t < length * std::cos(angle / 2); t += part) {
                const double half = t * std::tan(angle / 2);
                const double below = std::min(half, 0.0052), above = std::min(half, 0.0048);
                between += part * (below + above);
                for (const double side : {0.0052, 0.0048})
                    if (half < side) rim += part / std::cos(angle / 2);
                if (t + part >= length * std::cos(angle / 2)) rim += below + above;
            }
            EXPECT_NEAR(done.area / (scale * scale), between, 0.5 * spacing * rim);
            EXPECT_FALSE(world.report().tools.at(0).is_in_tissue);
        }
}

// Opened half way, they leave a cut that ends there. Closed again, they go on; once more, nothing
// changes.
TEST(Scissors, OpenAndCloseAgain) {
    for (const Solver solver : {Solver::semi_implicit_euler, Solver::implicit_euler}) {
        Snip s{.solver = solver};
        s.num_steps = 8;
        World world = strip(s);
        const ToolId tool = add_scissors(world, s);
        EXPECT_FALSE(world.is_tool_closed(tool));
        Outcome first;
        world.close_tool(tool);
        EXPECT_TRUE(world.is_tool_closed(tool));
        step(world, s, 4, first);
        EXPECT_TRUE(world.report().tools.at(0).is_in_tissue);
        EXPECT_NE(input_error_of([&] { world.place_tool(tool, across_strip(s)); }).find("in the"),
                  std::string::npos);
        world.open_tool(tool);
        step(world, s, 6, first);
        EXPECT_FALSE(world.report().tools.at(0).is_in_tissue);
        EXPECT_EQ(topology::components(world.mesh()).count, 1);
        EXPECT_GT(first.area, 0.2 * 0.02 * 0.01);
        const Outcome second = close(world, s, tool);
        EXPECT_EQ(topology::components(world.mesh()).count, 2);
        EXPECT_NEAR(first.area + second.area, 0.02 * 0.01, 0.02 * 0.02 * 0.01);
        Outcome opening;
        world.open_tool(tool);
        step(world, s, 10, opening);
        EXPECT_EQ(opening.num_edits, 0U);
        EXPECT_EQ(close(world, s, tool).num_edits, 0U);
    }
}

// Scissors that open while they move leave the end of the cut where it was.
TEST(Scissors, CutNothingWhileTheyOpen) {
    Snip s;
    s.num_steps = 8;
    Outcome still, moved;
    for (const double away : {0.0, 0.01}) {
        World world = strip(s);
        const ToolId tool = add_scissors(world, s);
        Outcome& done = away == 0.0 ? still : moved;
        world.close_tool(tool);
        step(world, s, 4, done);
        world.open_tool(tool);
        Pose pose = across_strip(s);
        pose.position.y() += away;
        step(world, s, 3, done, StepInputs().move(tool, pose));
        EXPECT_FALSE(world.report().tools.at(0).is_in_tissue);
    }
    EXPECT_EQ(moved.area, still.area);
}

// In statics the body moves to its equilibrium after a cut, past blades that have closed.
TEST(Scissors, HaveCutWhenTheyHaveClosedInStatics) {
    Snip s{.solver = Solver::statics, .x = 0.0176, .z = 0.0052};
    s.length = 0.022;
    s.num_steps = 3;
    World world = strip(s);
    const ToolId tool = add_scissors(world, s);
    Outcome done;
    world.close_tool(tool);
    step(world, s, 3, done);
    EXPECT_FALSE(world.report().tools.at(0).is_in_tissue);
    Outcome after;
    std::vector<CellId> cells;
    for (const CellId e : world.mesh().elements()) cells.push_back(e);
    world.add_load({.name = "pull", .kind = physics::BodyLoad{{cells}, {0, 2e4, 0}}});
    step(world, s, 2, after);
    EXPECT_EQ(after.num_edits, 0U);
}

// Open scissors cut nothing, wherever they go.
TEST(Scissors, CutNothingWhileTheyAreOpen) {
    Snip s;
    World world = strip(s);
    const ToolId tool = add_scissors(world, s);
    Outcome done;
    for (const double y : {0.0, 0.01, 0.02, 0.03}) {
        Pose pose = across_strip(s);
        pose.position.y() = y;
        step(world, s, 1, done, StepInputs().move(tool, pose));
    }
    EXPECT_EQ(done.num_edits, 0U);
}

// They may be withdrawn while they close, and come back open.
TEST(Scissors, EndTheirCutWhenTheyLeave) {
    Snip s;
    s.num_steps = 8;
    World world = strip(s);
    const ToolId tool = add_scissors(world, s);
    Outcome done;
    world.close_tool(tool);
    step(world, s, 4, done);
    step(world, s, 1, done, StepInputs().withdraw(tool));
    EXPECT_FALSE(world.is_tool_present(tool));
    EXPECT_FALSE(world.is_tool_closed(tool));
    EXPECT_GT(done.num_edits, 0U);
    world.place_tool(tool, across_strip(s));
    EXPECT_EQ(topology::components(world.mesh()).count, 1);
    close(world, s, tool);
    EXPECT_EQ(topology::components(world.mesh()).count, 2);
}

TEST(Scissors, GoOnWithTheSameBitsAfterRestoreAndUndo) {
    for (const Solver solver : {Solver::semi_implicit_euler, Solver::implicit_euler}) {
        Snip s{.solver = solver, .jitter = 0.3};
        s.num_steps = 6;
        World world = strip(s);
        const ToolId tool = add_scissors(world, s);
        std::vector<UndoPoint> points;
        std::vector<std::string> states;
        for (int i = 0; i < 12; ++i) {
            if (i == 1 || i == 7) world.close_tool(tool);
            if (i == 4) world.open_tool(tool);
            points.push_back(world.undo_point());
            states.push_back(world.save());
            world.step(0.5 * world.rest_stable_step());
        }
        const std::string end = world.save();
        for (const std::size_t from : {2U, 3U, 5U, 9U}) {
            World resumed = strip(s);
            resumed.restore(states[from]);
            EXPECT_EQ(resumed.save(), states[from]);
            for (int i = static_cast<int>(from); i < 12; ++i) {
                if (i > static_cast<int>(from)) {
                    if (i == 7) resumed.close_tool(resumed.tools()[0]);
                    if (i == 4) resumed.open_tool(resumed.tools()[0]);
                }
                resumed.step(0.5 * resumed.rest_stable_step());
            }
            EXPECT_EQ(resumed.save(), end) << from;
        }
        for (std::size_t i = points.size(); i-- > 0;) {
            world.undo(points[i]);
            EXPECT_EQ(world.save(), states[i]) << i;
        }
    }
}

TEST(Scissors, DivideHexahedra) {
    WorldDef def = soft_body();
    def.mesh = topology::box_mesh(topology::CellKind::hexahedron, Vec3::Zero(),
                                  Vec3::Constant(size), {4, 4, 4});
    def.materials = {{1000.0, physics::HybridSprings{400.0, 400.0}}};
    World world(std::move(def));
    const ToolId tool = world.add_tool({"scissors", Scissors{0.2, 1.0, 0.01}});
    world.place_tool(tool, {across_strip({}).rotation, {0.051, -0.05, 0.05}});
    world.close_tool(tool);
    for (int i = 0; i < 1000 && world.mesh().num_elements() == 64U; ++i)
        world.step(0.5 * world.stable_step());
    EXPECT_GT(world.mesh().num_elements(), 64U);
}

TEST(Scissors, AreRefusedIfTheyCannotBe) {
    World world = strip({});
    const auto error_of = [&](const Scissors& scissors) {
        return input_error_of([&] { world.add_tool({"s", scissors}); });
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double length : {0.0, -1.0, nan})
        EXPECT_THAT(error_of({length}), HasSubstr("length"));
    for (const double angle : {0.0, 1e-18, 2.5, nan})
        EXPECT_THAT(error_of({0.01, angle}), HasSubstr("angle"));
    for (const double time : {0.0, -1.0, nan})
        EXPECT_THAT(error_of({0.01, 0.5, time}), HasSubstr("closing time"));
    EXPECT_THAT(error_of({0.01, 0.5, 0.1, 0.6}), HasSubstr("snap"));
    const ToolId absent = world.add_tool({"s", Scissors{0.01}});
    EXPECT_THAT(input_error_of([&] { world.close_tool(absent); }), HasSubstr("not there"));
    EXPECT_THAT(input_error_of([&] { world.open_tool(absent); }), HasSubstr("not there"));
    EXPECT_THAT(input_error_of([&] { world.tie_suture(absent); }), HasSubstr("no suture"));
}

}  // namespace
}  // namespace incise::sim
