// What is told of overrides that cannot be.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::scenario {
namespace {

using Lines = std::vector<std::string>;

TEST(Overrides, AreQuotedByTheirErrors) {
    const ScenarioFile file(minimal);
    const auto error = [&](const std::string& text) {
        const auto errors = file.errors({"title=fine", text});
        return errors.size() == 1 ? errors[0] : std::to_string(errors.size()) + " errors";
    };
    EXPECT_EQ(error("dynamics.end_time=-1"),
              "--set dynamics.end_time=-1: key 'dynamics.end_time': -1 is not allowed: must be "
              "above 0");
    EXPECT_EQ(
        error("dynamics.end_tim=1"),
        "--set dynamics.end_tim=1: key 'dynamics.end_tim': is not known; did you mean "
        "'end_time'? Known here: mode, integrator, end_time, time_step, steps, safety, damping, "
        "gravity, precision");
    EXPECT_EQ(error("dynamics.end_time=2s"),
              "--set dynamics.end_time=2s: key 'dynamics.end_time': must be a number, but is the "
              "text \"2s\"");
    EXPECT_EQ(error("dynamics.end_time"),
              "--set dynamics.end_time: an override has the form key.path=value");
    EXPECT_EQ(error("material[1].young=1"),
              "--set material[1].young=1: 'material' has no element "
              "1: it has 1, numbered from 0");
    EXPECT_EQ(error("material.young=1"),
              "--set material.young=1: 'material' is an array: go on "
              "with the number of an element, as in material[0]");
    EXPECT_EQ(error("dynamics[0]=1"),
              "--set dynamics[0]=1: 'dynamics' is a table, not an array: "
              "it has keys, no [0]");
    EXPECT_EQ(error("tool[3].time=1"),
              "--set tool[3].time=1: 'tool' is not there, so it has no [3]");
    EXPECT_EQ(error("material[0].pronny[0].tau=1"),
              "--set material[0].pronny[0].tau=1: 'material[0].pronny' is not there, so it has no "
              "[0]");
    EXPECT_EQ(error("dynamics.end_time.x=1"),
              "--set dynamics.end_time.x=1: 'dynamics.end_time' is the number 1: there is nothing "
              "below it");
    for (const auto& text : {"a..b=1", "=1", "a[=1", "a[x]=1", "a]=1"})
        EXPECT_NE(error(text).find("is not a path"), std::string::npos) << text;
    for (const auto& text : {"dynamics.gravity=[0, 0", "title=", "title=1\nx=2"})
        EXPECT_NE(error(text).find("is no TOML value"), std::string::npos) << text;
}

TEST(Overrides, AreAllReportedAtOnce) {
    const ScenarioFile file(minimal);
    const std::string array = "materials[0].young=-1", key = "dynamics.dampin=1",
                      element = "tool[3].x=1", value = "material[0].density=-2";
    const auto errors = file.errors({array, key, element, value});
    ASSERT_EQ(errors.size(), 4u);
    EXPECT_EQ(errors[0], "--set " + array +
                             ": 'materials' is not there, so it has no [0]; did you mean "
                             "'material'?");
    EXPECT_EQ(errors[1].find("--set " + key + ": key 'dynamics.dampin': is not known; did you"),
              0u);
    EXPECT_EQ(errors[2], "--set " + element + ": 'tool' is not there, so it has no [3]");
    EXPECT_EQ(errors[3].find("--set " + value + ": key 'material[0].density': -2"), 0u);
}

// Of what a path makes on its way nothing stays if it then cannot be.
TEST(Overrides, ThatCannotBeChangeNothing) {
    const std::string text = "expect.mass_error.max[0]=1";
    EXPECT_EQ(ScenarioFile(minimal).errors({text}),
              Lines{"--set " + text + ": 'expect.mass_error.max' is not there, so it has no [0]"});
}

}  // namespace
}  // namespace incise::scenario
