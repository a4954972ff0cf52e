// Failures of a motion end, in a run, with what its scenario can change.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/remedies.h"

#include <gtest/gtest.h>

#include <set>

#include "incise/base/error.h"
#include "run_folder.h"

namespace incise::runner {
namespace {

TEST(Remedies, AreThereForEachCauseAndDiffer) {
    using enum physics::FailureCause;
    std::set<std::string> remedies;
    for (const auto cause :
         {step_above_bound, constraint_too_fast, load_too_large, crushed_element, stiffened_tissue,
          no_implicit_step, no_equilibrium, free_component_loaded})
        remedies.insert(remedy_for(physics::MotionFailure(cause, "it is lost")));
    EXPECT_EQ(remedies.size(), 8u);
    EXPECT_FALSE(remedies.contains(""));
}

std::string failure_of(const std::string& text) {
    Simulation simulation(scenario_of(soft_cube + text));
    try {
        run(simulation);
    } catch (const physics::MotionFailure&) {
        return "without a remedy";
    } catch (const PhysicsError& error) {
        return error.what();
    }
    return "it goes on";
}

TEST(Remedies, EndTheMessagesOfRuns) {
    const std::string blown = failure_of(R"([[load]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
nodal_force = [0, 0, 1e9]
)" + dynamics(0.1));
    EXPECT_NE(blown.find("; likely cause: the load on it of 1e+09 N"), std::string::npos) << blown;
    EXPECT_TRUE(blown.ends_with(" kg; make it smaller or bring it up slowly")) << blown;
    const std::string thrown = failure_of(R"([[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.01, by = [0, 0, 1e3] }]
)" + dynamics(0.1));
    EXPECT_TRUE(thrown.ends_with("its constraint moves too fast; move it more slowly")) << thrown;
    const std::string afloat = failure_of(R"([[tool]]
kind = "cut"
time = 0.05
plane = { point = [0, 0, 0.05], normal = [0.2, 0.1, 1] }
)" + dynamics(0.2, "mode = \"static\"\nsteps = 10\ngravity = [0, 0, -1]\n"));
    EXPECT_TRUE(afloat.ends_with("or use mode = \"dynamic\"")) << afloat;
}

}  // namespace
}  // namespace incise::runner
