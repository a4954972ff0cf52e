// The promise of `check`: all problems of a scenario at once, each with its place.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::sim {
namespace {

using Lines = std::vector<std::string>;

TEST(AllProblems, OfMoreFramesThanADiskHolds) {
    const auto with = [](const std::string& interval) {
        return ScenarioFile(minimal + "[output]\ninterval = " + interval + "\n");
    };
    for (const std::string interval : {"1e-300", "1e-12", "9e-08"}) {
        const auto errors = with(interval).errors();
        ASSERT_EQ(errors.size(), 1u) << interval;
        EXPECT_EQ(errors[0].find("scene.toml:10:12: key 'output.interval': an interval of " +
                                 interval + " s makes "),
                  0u)
            << errors[0];
        EXPECT_EQ(with(interval).warnings(), Lines{});
    }
    EXPECT_EQ(with("1e-6").errors(), Lines{});
    EXPECT_EQ(with("1e-6").warnings(),
              Lines{"scene.toml:10:12: the output interval of 1e-06 s makes 1e+06 frames"});
    EXPECT_EQ(ScenarioFile(minimal).errors({"dynamics.end_time=1e9"}).size(), 1u)
        << "at the usual interval";
}

}  // namespace
}  // namespace incise::sim
