// Runs whose steps the caller chooses.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/step_policy.h"

#include <gtest/gtest.h>

#include <vector>

#include "incise/base/error.h"
#include "incise/runner/simulation.h"
#include "tests/runner/run_folder.h"

namespace incise::runner {
namespace {

struct FrameTimes : Observer {
    std::vector<double> frame_times;
    void on_frame(const Simulation& simulation) override {
        frame_times.push_back(simulation.time());
    }
};

TEST(StepPolicy, IsTakenFromTheCaller) {
    const Scenario scenario = scenario_of(soft_cube + dynamics(0.05));
    Simulation even(scenario);
    FrameTimes even_record, half_record;
    even.add_observer(even_record);
    run(even);
    Simulation half(scenario, [](const StepSituation& s) {
        const double end = even_steps(s);
        return end < s.stop ? 0.5 * (s.time + end) : end;
    });
    half.add_observer(half_record);
    run(half);
    EXPECT_GT(half.num_steps(), even.num_steps());
    EXPECT_EQ(half_record.frame_times, even_record.frame_times);
    Simulation odd(scenario, [](const StepSituation& s) { return s.stop + 1.0; });
    EXPECT_THROW(odd.step(), InputError);
    Simulation stuck(scenario, [](const StepSituation& s) { return s.time; });
    EXPECT_THROW(stuck.step(), InputError);
}

}  // namespace
}  // namespace incise::runner
