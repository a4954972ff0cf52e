// Where a tool is when, and that nothing between its poses is missed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/tool.h"

#include <gtest/gtest.h>

#include <numbers>

#include "run_folder.h"

namespace incise::sim {
namespace {

constexpr double pi = std::numbers::pi;

Tool tool_on(std::vector<TimeKey<Pose>> path) {
    ToolSpec spec;
    spec.kind = Carver{SphereShape{0.1}};
    spec.path = std::move(path);
    std::vector<std::string> warnings;
    return Tool(spec, {}, warnings);
}

double angle_between(const cutting::Pose& pose, double angle, const Vec3& axis) {
    return pose.rotation.angularDistance(
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())));
}

TEST(Tool, IsAtItsKeysAndOnStraightLinesBetweenThem) {
    const Tool tool = tool_on({{1.0, {{0, 0, 0}, Vec3::UnitZ(), 0.0}},
                               {2.0, {{1, 2, -4}, Vec3::UnitZ(), 0.5 * pi}},
                               {4.0, {{1, 0, 0}, Vec3::UnitX(), pi / 3}}});
    EXPECT_EQ(tool.pose(1.0).position, Vec3(0, 0, 0));
    EXPECT_EQ(tool.pose(1.25).position, Vec3(0.25, 0.5, -1));
    EXPECT_EQ(tool.pose(2.0).position, Vec3(1, 2, -4));
    EXPECT_EQ(tool.pose(3.0).position, Vec3(1, 1, -2));
    EXPECT_EQ(tool.pose(4.0).position, Vec3(1, 0, 0));
    EXPECT_NEAR(angle_between(tool.pose(1.0), 0.0, Vec3::UnitZ()), 0.0, 1e-7);
    EXPECT_NEAR(angle_between(tool.pose(1.5), pi / 4, Vec3::UnitZ()), 0.0, 1e-7);
    EXPECT_NEAR(angle_between(tool.pose(2.0), pi / 2, Vec3::UnitZ()), 0.0, 1e-7);
    EXPECT_NEAR(angle_between(tool.pose(4.0), pi / 3, Vec3::UnitX()), 0.0, 1e-7);
    // Evenly along the shortest turn from one to the other.
    const double whole = tool.pose(2.0).rotation.angularDistance(tool.pose(4.0).rotation);
    EXPECT_NEAR(tool.pose(2.0).rotation.angularDistance(tool.pose(2.5).rotation), whole / 4, 1e-7);
    EXPECT_NEAR(tool.pose(2.5).rotation.angularDistance(tool.pose(4.0).rotation), 3 * whole / 4,
                1e-7);
    // A point of the tool goes where its pose takes it.
    EXPECT_NEAR((tool.pose(2.0).to_world({1, 0, 0}) - Vec3(1, 3, -4)).norm(), 0.0, 1e-15);
    EXPECT_NEAR((tool.pose(2.7).to_tool(tool.pose(2.7).to_world({3, 4, 5})) - Vec3(3, 4, 5)).norm(),
                0.0, 1e-14);
}

TEST(Tool, StaysAtItsEndsBeforeAndAfter) {
    const Tool tool =
        tool_on({{1.0, {{1, 0, 0}, Vec3::UnitZ(), 0.0}}, {2.0, {{5, 0, 0}, Vec3::UnitZ(), 1.0}}});
    EXPECT_EQ(tool.pose(-3.0).position, Vec3(1, 0, 0));
    EXPECT_EQ(tool.pose(0.5).position, Vec3(1, 0, 0));
    EXPECT_EQ(tool.pose(9.0).position, Vec3(5, 0, 0));
    EXPECT_NEAR(angle_between(tool.pose(9.0), 1.0, Vec3::UnitZ()), 0.0, 1e-7);
}

TEST(Tool, IsThereFromItsFirstToItsLastKey) {
    const Tool tool = tool_on({{1.0, {}}, {2.0, {}}});
    EXPECT_FALSE(tool.is_present(0.0, 0.5));
    EXPECT_FALSE(tool.is_present(0.5, 1.0));
    EXPECT_TRUE(tool.is_present(0.9, 1.1));
    EXPECT_TRUE(tool.is_present(1.0, 1.1));
    EXPECT_TRUE(tool.is_present(1.4, 1.5));
    EXPECT_TRUE(tool.is_present(1.9, 2.0));
    EXPECT_TRUE(tool.is_present(0.0, 9.0));
    EXPECT_FALSE(tool.is_present(2.0, 2.1));
    EXPECT_FALSE(tool.is_present(3.0, 4.0));
}

TEST(Tool, WithOneKeyActsInExactlyOneStep) {
    for (const double time : {0.0, 0.1, 0.25, 0.3, 1.0}) {
        const Tool tool = tool_on({{time, {}}});
        int num_steps = 0;
        for (int i = 0; i < 10; ++i) num_steps += tool.is_present(i / 10.0, (i + 1) / 10.0);
        EXPECT_EQ(num_steps, 1) << time;
    }
}

TEST(Tool, WithOneKeyCarvesWhenItsTimeComes) {
    for (const char* time : {"0", "0.02", "0.0234", "0.05"}) {
        Simulation simulation(scenario_of(soft_cube + dynamics(0.05) + R"(
[[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = )" + time + ", at = [0.05, 0.05, 0.1] }]\n"));
        run(simulation);
        ASSERT_EQ(simulation.ledger().edits().size(), 1u) << time;
        const double at = simulation.ledger().edits()[0].time;
        EXPECT_GE(at, std::stod(time));
        EXPECT_LE(at, std::stod(time) + 0.01);
    }
}

TEST(Tool, PathThatEndsBetweenTwoStepsIsFollowedToItsEnd) {
    // The last bit of the blade's way lies within a step; without it the cube holds together.
    Simulation simulation(scenario_of(soft_cube + dynamics(0.1) + R"(
[[tool]]
kind = "blade"
mode = "separate"
edge = [[0, -1, 0.052], [0, 1, 0.049]]
path = [{ time = 0.0123, at = [-0.01, 0, 0] }, { time = 0.0671, at = [0.101, 0, 0] }]
)"));
    run(simulation);
    EXPECT_EQ(simulation.ledger().edits().back().after.components, 2);
    EXPECT_GT(simulation.ledger().edits().size(), 2u);
}

}  // namespace
}  // namespace incise::sim
