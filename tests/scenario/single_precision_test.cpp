// What is told of meshes that single precision cannot compute with.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include "scenario_file.h"

namespace incise::scenario {
namespace {

std::vector<std::string> warnings_of_box(const std::string& thickness,
                                         const std::string& precision) {
    const ScenarioFile file("[mesh]\nbox = { size = [1, 1, " + thickness +
                            "], cells = [1, 1, 1] }\n" + minimal_rest + "precision = \"" +
                            precision + "\"\n");
    return check_body(file.read().scenario).warnings;
}

TEST(SinglePrecision, WarnsOfThinTetrahedra) {
    const auto warnings = warnings_of_box("0.002", "single");
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("scene.toml:9:13: key 'dynamics.precision': \"single\" leaves no "
                               "strain to speak of in 6 tetrahedra"),
              std::string::npos)
        << warnings[0];
    EXPECT_TRUE(warnings_of_box("0.05", "single").empty());
    EXPECT_TRUE(warnings_of_box("0.002", "double").empty());
}

}  // namespace
}  // namespace incise::scenario
