// Where a tool is when, and that nothing between its poses is missed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <numbers>

#include "incise/scenario/tool_build.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

constexpr double pi = std::numbers::pi;

/// p -> at + R(axis, angle) p.
Pose pose_at(const Vec3& at, const Vec3& axis = Vec3::UnitZ(), double angle = 0.0) {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), at};
}

double angle_between(const Pose& pose, double angle, const Vec3& axis) {
    return pose.rotation.angularDistance(
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis.normalized())));
}

TEST(Tool, IsAtItsKeysAndStraightBetweenThem) {
    const ToolPath tool({{1.0, pose_at({0, 0, 0})},
                         {2.0, pose_at({1, 2, -4}, Vec3::UnitZ(), 0.5 * pi)},
                         {4.0, pose_at({1, 0, 0}, Vec3::UnitX(), pi / 3)}});
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
    const ToolPath tool({{1.0, pose_at({1, 0, 0})}, {2.0, pose_at({5, 0, 0}, Vec3::UnitZ(), 1.0)}});
    EXPECT_EQ(tool.pose(-3.0).position, Vec3(1, 0, 0));
    EXPECT_EQ(tool.pose(0.5).position, Vec3(1, 0, 0));
    EXPECT_EQ(tool.pose(9.0).position, Vec3(5, 0, 0));
    EXPECT_NEAR(angle_between(tool.pose(9.0), 1.0, Vec3::UnitZ()), 0.0, 1e-7);
}

TEST(Tool, IsPresentFromFirstToLastKey) {
    const ToolPath tool({{1.0, {}}, {2.0, {}}});
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

ToolSpec spec_of(cutting::ToolShape shape, std::vector<TimeKey<Pose>> path) {
    ToolSpec spec;
    spec.shape = std::move(shape);
    spec.path = std::move(path);
    return spec;
}

bool may_meet_unit_box(const ToolSpec& spec) {
    std::vector<std::string> warnings;
    return may_meet(build_tool(spec, warnings), {Vec3::Zero(), Vec3::Ones()});
}

TEST(Tool, MayMeetABoxByPathAndReach) {
    const auto at = [](double x) { return TimeKey<Pose>{0.0, pose_at({x, 0.5, 0.5})}; };
    const auto there = [](double x) { return TimeKey<Pose>{1.0, pose_at({x, 0.5, 0.5})}; };
    const cutting::Carver ball{cutting::Sphere{0.25}};
    const cutting::Carver rod{cutting::Capsule{{0, 0, 0}, {0.5, 0, 0}, 0.25}};
    const cutting::Carver block{cutting::Cuboid{{0.5, 4, 4}}};
    EXPECT_TRUE(may_meet_unit_box(spec_of(ball, {at(1.24)})));
    EXPECT_FALSE(may_meet_unit_box(spec_of(ball, {at(1.26)})));
    EXPECT_TRUE(may_meet_unit_box(spec_of(ball, {at(-5), there(5)})));  // right through
    EXPECT_FALSE(may_meet_unit_box(spec_of(ball, {at(5), there(1.26)})));
    EXPECT_TRUE(may_meet_unit_box(spec_of(rod, {at(-0.74)})));
    EXPECT_FALSE(may_meet_unit_box(spec_of(rod, {at(-0.76)})));
    EXPECT_TRUE(may_meet_unit_box(spec_of(block, {at(1.24)})));
    EXPECT_FALSE(may_meet_unit_box(spec_of(block, {at(1.26)})));
    const cutting::Blade blade{{{0, -1, 0}, {0, 1, 0}}};
    EXPECT_TRUE(may_meet_unit_box(spec_of(blade, {at(3), there(0.99)})));
    EXPECT_FALSE(may_meet_unit_box(spec_of(blade, {at(3), there(1.01)})));
    const auto cut_at = [](double x) { return cutting::PlaneCut{{x, 0, 0}, Vec3::UnitX()}; };
    EXPECT_TRUE(may_meet_unit_box(spec_of(cut_at(0.9), {at(0)})));
    EXPECT_FALSE(may_meet_unit_box(spec_of(cut_at(1.1), {at(0)})));
}

TEST(Tool, MayMeetWhateverItReachesWhileTurning) {
    // Between its keys the tip is farther out in x than at either of them.
    for (const double angle : {0.1, 0.5, 1.0, 0.99 * pi}) {
        const Pose down = pose_at({0, 0, 0}, Vec3::UnitZ(), -angle / 2),
                   up = pose_at({0, 3, -2}, Vec3::UnitZ(), angle / 2);
        ToolSpec spec = spec_of(cutting::Blade{{{1, 0, 0}, {2, 0, 0}}}, {{0.0, down}, {1.0, up}});
        std::vector<std::string> warnings;
        const ScriptedTool tool = build_tool(spec, warnings);
        for (int i = 0; i <= 1000; ++i) {
            const Vec3 x = tool.path.pose(i / 1000.0).to_world({2, 0, 0});
            EXPECT_TRUE(may_meet(tool, Box(x, x))) << angle << " " << i;
        }
        EXPECT_FALSE(may_meet(tool, Box(Vec3(5, -9, -9), Vec3(6, 9, 9))));
    }
}

TEST(Tool, OutOfReachOfTheBodyWarns) {
    const std::string ball = R"([[tool]]
kind = "carver"
shape = { sphere = { radius = 0.01 } }
path = [{ time = 0, at = [0.05, 0.05, )";
    const auto warnings = [&](const std::string& tools) {
        return Simulation(scenario_of(soft_cube + dynamics(0.1) + tools)).warnings();
    };
    EXPECT_EQ(warnings(two_tools + ball + "0.109] }]\n"), std::vector<std::string>{});
    const auto told = warnings(two_tools + ball + "109] }]\n");
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(
        told[0].substr(told[0].find("scene.toml")),
        "scene.toml:26:1: tool 'carver_2' touches nothing where the body rests, between [0, 0, 0] "
        "and [0.1, 0.1, 0.1]; check its coordinates and units, unless the tissue moves to it");
}

TEST(Tool, WithOneKeyActsInExactlyOneStep) {
    for (const double time : {0.0, 0.1, 0.25, 0.3, 1.0}) {
        const ToolPath tool(std::vector<TimeKey<Pose>>{{time, {}}});
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
        ASSERT_EQ(simulation.edits().size(), 1u) << time;
        const double at = simulation.edits()[0].time;
        EXPECT_GE(at, std::stod(time));
        EXPECT_LE(at, std::stod(time) + 0.01);
    }
}

TEST(Tool, FollowsItsPathToAnEndBetweenSteps) {
    // The last bit of the blade's way lies within a step; without it the cube holds together.
    Simulation simulation(scenario_of(soft_cube + dynamics(0.1) + R"(
[[tool]]
kind = "blade"
mode = "separate"
edge = [[0, -1, 0.052], [0, 1, 0.049]]
path = [{ time = 0.0123, at = [-0.01, 0, 0] }, { time = 0.0671, at = [0.101, 0, 0] }]
)"));
    run(simulation);
    EXPECT_EQ(simulation.edits().back().after.components, 2);
    EXPECT_GT(simulation.edits().size(), 2u);
}

}  // namespace
}  // namespace incise::runner
