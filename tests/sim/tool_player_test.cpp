// Tools and grasps that are led through intervals of several steps, and the mean forces on them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tool_player.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>

#include "incise/base/archive.h"
#include "incise/sim/tool_forces.h"
#include "tests/sim/soft_world.h"

namespace incise::sim {
namespace {

/// A held cube without gravity, so that it stays under the tools.
World resting_world() {
    WorldDef def = soft_body();
    def.gravity.setZero();
    return held(World(std::move(def)));
}

constexpr double radius = 0.02;  // of the ball, m
const Vec3 above{0.05, 0.05, size + radius};

/// A ball that touches the top of the cube.
ToolId add_ball(World& world) {
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{radius}, 0.3}});
    world.place_tool(ball, at(above));
    return ball;
}

cutting::Suture short_thread() {
    return {{{0.3 * size, 0.5 * size, 0.5 * size}, {0.7 * size, 0.5 * size, 0.6 * size}}, 20.0};
}

ConstraintId grasp_corner(World& world, const Pose& pose) {
    const auto is_corner = [](const Vec3& x) { return x.z() == size && x.x() < 0.3 * size; };
    return world.grasp("hand", nodes_where(world, is_corner), pose);
}

/// Plays an interval of steps, each longer than the one before.
/// @param after_step  is given the number of the step, from 1, and the part of the interval so far
void play(World& world, ToolPlayer& player, int num_steps,
          const std::function<void(int, double)>& after_step = {}) {
    const double unit = 0.7 * world.rest_stable_step() / num_steps;
    player.begin(world);
    for (int i = 1; i <= num_steps; ++i) {
        const double part = i * (i + 1.0) / (num_steps * (num_steps + 1.0));
        player.add(world.step(i * unit, player.inputs(part, i == num_steps)));
        if (after_step) after_step(i, part);
    }
    player.end();
}

void expect_near(const Pose& pose, const Pose& expected) {
    EXPECT_LT((pose.position - expected.position).norm(), 1e-15);
    EXPECT_LT((pose.rotation.coeffs() - expected.rotation.coeffs()).norm(), 1e-14);
}

void expect_same(const Pose& pose, const Pose& expected) {
    EXPECT_EQ(pose.position, expected.position);
    EXPECT_EQ(pose.rotation.coeffs(), expected.rotation.coeffs());
}

TEST(ToolPlayer, LeadsAProbeStraightToItsTarget) {
    World world = resting_world();
    const ToolId ball = add_ball(world);
    const Pose start = at(above);
    const Pose target{Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3.0)),
                      above + Vec3(0.01, -0.02, 0.005)};
    ToolPlayer player;
    player.targets().move(ball, target);
    play(world, player, 7, [&](int, double part) {
        expect_near(world.tool_pose(ball), interpolate(start, target, part));
    });
    expect_same(world.tool_pose(ball), target);
    // Nothing has a target any more.
    play(world, player, 2);
    expect_same(world.tool_pose(ball), target);
}

TEST(ToolPlayer, HasAToolThatComesAtItsTargetAtOnce) {
    World world = resting_world();
    const ToolId ball = world.add_tool({"ball", cutting::Probe{cutting::Sphere{radius}}});
    const Pose target = at(above + Vec3(0, 0, 0.01));
    ToolPlayer player;
    player.targets().move(ball, target);
    EXPECT_FALSE(world.is_tool_present(ball));
    play(world, player, 3, [&](int, double) {
        ASSERT_TRUE(world.is_tool_present(ball));
        expect_same(world.tool_pose(ball), target);
    });
}

TEST(ToolPlayer, WithdrawsToolsAtTheEndAndCutsAtTheBeginning) {
    constexpr int num_steps = 4;
    World world = resting_world();
    const ToolId ball = add_ball(world);
    const ToolId plane =
        world.add_tool({"plane", cutting::PlaneCut{{0, 0, 0.52 * size}, Vec3::UnitZ()}});
    world.place_tool(plane, Pose());
    ToolPlayer player;
    player.targets().move(ball, at(above + Vec3(0, 0, 0.01))).withdraw(ball).withdraw(plane);
    play(world, player, num_steps, [&](int i, double) {
        EXPECT_EQ(world.is_tool_present(ball), i < num_steps) << i;
        EXPECT_FALSE(world.is_tool_present(plane)) << i;
        EXPECT_EQ(world.report().edits.size(), i == 1 ? 1u : 0u) << i;
    });
    EXPECT_EQ(world.ledger().last().components, 2);
    expect_same(world.tool_pose(ball), at(above + Vec3(0, 0, 0.01)));
}

TEST(ToolPlayer, DrawsThreadsAndLeadsGraspsEvenly) {
    World world = resting_world();
    const ToolId suture = world.add_tool({"thread", short_thread()});
    ASSERT_EQ(world.tie_suture(suture), 2u);
    const Pose start = at({0.01, 0.02, size});
    const ConstraintId hand = grasp_corner(world, start);
    const double length = world.suture_length(suture), drawn = 0.8 * length;
    const Pose target{Eigen::Quaterniond(Eigen::AngleAxisd(0.05, Vec3::UnitY())),
                      start.position + Vec3(0, 0.001, 0.002)};
    ToolPlayer player;
    player.targets().draw(suture, drawn).move(hand, target);
    play(world, player, 7, [&](int, double part) {
        EXPECT_NEAR(world.suture_length(suture), std::lerp(length, drawn, part), 1e-15);
        expect_near(world.grasp_pose(hand).value(), interpolate(start, target, part));
    });
    EXPECT_EQ(world.suture_length(suture), drawn);
    expect_same(world.grasp_pose(hand).value(), target);
}

// The longer a step, the more its force counts.
TEST(ToolPlayer, GivesMeanForcesOverTheInterval) {
    World world = resting_world();
    const ToolId ball = add_ball(world), other = add_ball(world);
    world.place_tool(other, at(above + Vec3(0, 0, size)));
    ToolPlayer player;
    for (const Vec3& by : {Vec3(0, 0, -0.003), Vec3(-0.002, 0, -0.006)}) {
        player.targets().move(
            ball, {Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Vec3::UnitX())), above + by});
        const double from = world.time();
        double time = 0.0, largest = 0.0;
        Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero();
        play(world, player, 7, [&](int, double) {
            const StepReport& report = world.report();
            const double dt = report.to - report.from;
            time += dt;
            impulse += dt * report.tools.at(0).force;
            angular_impulse += dt * report.tools.at(0).torque;
            largest = std::max(largest, report.tools.at(0).force.norm());
        });
        const ToolForces& forces = player.forces();
        EXPECT_EQ(forces.from(), from);
        EXPECT_EQ(forces.to(), world.time());
        const auto [force, torque] = forces.of(ball);
        EXPECT_GT(force.norm(), 0.01 * largest);
        EXPECT_GT(torque.norm(), 0.0);
        EXPECT_LE((force - impulse / time).norm(), 1e-12 * force.norm());
        EXPECT_LE((torque - angular_impulse / time).norm(), 1e-12 * torque.norm());
        EXPECT_EQ(forces.of(other).force, Vec3(Vec3::Zero()));
    }
    player.begin(world);
    EXPECT_EQ(player.forces().of(ball).force, Vec3(Vec3::Zero()));
    EXPECT_EQ(player.forces().of(ball).torque, Vec3(Vec3::Zero()));
    EXPECT_EQ(player.forces().from(), world.time());
    EXPECT_EQ(player.forces().to(), world.time());
}

/// A world with something of all that a player leads.
struct Theatre {
    World world = resting_world();
    ToolId ball, knife, suture;
    ConstraintId hand;
};
Theatre theatre() {
    Theatre t;
    t.ball = add_ball(t.world);
    t.knife = t.world.add_tool(scalpel());
    t.world.place_tool(t.knife, scalpel_pose(0.0));
    t.suture = t.world.add_tool({"thread", short_thread()});
    t.world.tie_suture(t.suture);
    t.hand = grasp_corner(t.world, Pose());
    return t;
}

StepInputs targets_of(const Theatre& t) {
    const Pose before = scalpel_pose(0.4);
    return StepInputs()
        .move(t.ball, at(above - Vec3(0, 0, 0.003)))
        .move(t.knife, scalpel_pose(0.5))
        .withdraw(t.knife, &before)
        .draw(t.suture, 0.9 * t.world.suture_length(t.suture))
        .move(t.hand, at({0, 0, 0.001}));
}

TEST(ToolPlayer, GoesOnWithTheSameBitsFromSavedTargets) {
    Theatre t = theatre();
    World& world = t.world;
    world.step(0.5 * world.stable_step());
    ToolPlayer player;
    player.targets() = targets_of(t);
    ArchiveWriter out;
    player.save(out);
    const std::string targets = out.take(), state = world.save();

    World other = resting_world();
    other.restore(state);
    ArchiveReader in(targets);
    const auto saved = in.read<StepInputs>();
    ToolPlayer resumed;
    resumed.restore(saved, other);
    play(world, player, 5);
    EXPECT_FALSE(world.is_tool_present(t.knife));
    EXPECT_GT(world.ledger().num_edits(), 0u);
    play(other, resumed, 5);
    EXPECT_EQ(other.save(), world.save());
    EXPECT_EQ(resumed.forces().of(t.ball).force, player.forces().of(t.ball).force);
}

TEST(ToolPlayer, LeavesOutTargetsOfWhatAWorldDoesNotHave) {
    const Theatre t = theatre();
    ToolPlayer player;
    World empty = resting_world();
    const ToolId ball = add_ball(empty);
    player.targets().move(ball, at(above));
    // It has the ball, but not the knife and the hand.
    player.restore(targets_of(t), empty);
    EXPECT_EQ(player.targets().tools().size(), 1u);
    EXPECT_EQ(player.targets().grasps().size(), 0u);
    ASSERT_NE(player.targets().find(ball), nullptr);
    player.restore(StepInputs().withdraw(t.knife).move(t.hand, Pose()), empty);
    EXPECT_EQ(player.targets().tools().size(), 0u);
    EXPECT_NO_THROW(player.begin(empty));
}

// An interval is given up after its first step, in which a plane has cut and was withdrawn.
TEST(ToolPlayer, DoesNotCutAgainInAnIntervalThatIsGivenUp) {
    World world = resting_world();
    const ToolId plane =
        world.add_tool({"plane", cutting::PlaneCut{{0, 0, 0.52 * size}, Vec3::UnitZ()}});
    for (const bool has_pose : {false, true}) {
        SCOPED_TRACE(has_pose);
        if (!has_pose) world.place_tool(plane, Pose());
        ToolPlayer player;
        player.targets().withdraw(plane);
        if (has_pose) player.targets().move(plane, Pose());
        player.begin(world);
        player.add(world.step(0.5 * world.stable_step(), player.inputs(0.1, false)));
        EXPECT_FALSE(world.is_tool_present(plane));
        player.begin(world);
        player.add(world.step(0.5 * world.stable_step(), player.inputs(1.0, true)));
        EXPECT_FALSE(world.is_tool_present(plane));
        EXPECT_TRUE(world.report().edits.empty());
    }
}

}  // namespace
}  // namespace incise::sim
