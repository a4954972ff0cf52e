// The stable step in strain, and steps that are longer than it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/sim/soft_world.h"
#include "tests/sim/strained_cuts.h"

namespace incise::sim {
namespace {

TEST(StrainedStep, KeepsRandomCutsStable) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        StrainedCut c = strained_cut(seed);
        const std::string what = describe(c);
        const auto failure = failure_in_a_world(std::move(c));
        EXPECT_FALSE(failure) << "seed " << seed << ", " << what << failure.value_or("");
    }
}

TEST(StrainedStep, IsNeededBySomeOfTheCuts) {
    int num_failures = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        num_failures += failure_at_rest_steps(strained_cut(seed)).has_value();
    EXPECT_GE(num_failures, 2);
}

/// Draws out a bar to twice its length.
World drawn_world() {
    StrainedCut c = strained_cut(1);
    c.def.constraints[1].displacement = physics::TimeCurve<Vec3>(
        {{0.0, Vec3::Zero()}, {StrainedCut::drawn_at, StrainedCut::length * Vec3::UnitX()}});
    World world(std::move(c.def));
    while (world.time() < StrainedCut::drawn_at) world.step(0.8 * world.stable_step());
    return world;
}

TEST(StrainedStep, FollowsStrainAndReturns) {
    World world(soft_body());
    EXPECT_EQ(world.stable_step(), world.rest_stable_step());
    World drawn = drawn_world();
    EXPECT_LT(drawn.stable_step(), 0.9 * drawn.rest_stable_step());
    EXPECT_GT(drawn.stable_step(), 0.3 * drawn.rest_stable_step());
    const double rest = drawn.rest_stable_step();
    drawn.release(drawn.constraints()[1]);
    while (drawn.time() < 3.0) drawn.step(0.8 * drawn.stable_step());
    EXPECT_EQ(drawn.rest_stable_step(), rest);
    EXPECT_GT(drawn.stable_step(), 0.97 * rest);
}

TEST(StrainedStep, DividesLongerSteps) {
    World world = drawn_world();
    const double dt = 0.95 * world.rest_stable_step();
    std::size_t most = 0;
    for (int i = 0; i < 200; ++i) {
        const double from = world.time(), bound = world.stable_step();
        const StepReport& report = world.step(dt);
        EXPECT_EQ(report.to, from + dt);
        EXPECT_LE(dt, bound * static_cast<double>(report.num_substeps) * (1.0 + 1e-7));
        EXPECT_GT(dt, bound * static_cast<double>(report.num_substeps - 1));
        most = std::max(most, report.num_substeps);
    }
    EXPECT_GT(most, 1u);
    EXPECT_EQ(world.step(0.8 * world.stable_step()).num_substeps, 1u);
    EXPECT_NE(input_error_of([&] {
                  world.step(1.01 * world.rest_stable_step());
              }).find("above the stable step"),
              std::string::npos);
}

TEST(StrainedStep, GoesOnWithTheSameBitsAfterRestore) {
    const auto run = [](World& world, int from, int to) {
        for (int i = from; i < to; ++i) {
            StepInputs inputs;
            if (i == 40) inputs = cut_along(world, Vec3(0.1, 0, 0), Vec3(1, 0.3, 0));
            world.step((i % 7 == 0 ? 1.0 : 0.8) * world.stable_step(), inputs);
        }
    };
    World whole = drawn_world();
    run(whole, 0, 150);
    const std::string end = whole.save();
    for (const int pause : {1, 41, 77}) {
        World first = drawn_world();
        run(first, 0, pause);
        World second = drawn_world();
        second.restore(first.save());
        second.set_num_threads(2);
        EXPECT_EQ(second.stable_step(), first.stable_step());
        run(second, pause, 150);
        EXPECT_TRUE(second.save() == end);
    }
}

}  // namespace
}  // namespace incise::sim
