// Runs with cuts leave the same bytes in all their files for any number of threads.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "run_folder.h"
#include "support/num_cases.h"
#include "support/run_files.h"

namespace incise::runner {
namespace {

using support::expect_same;
using support::files_of;

/// Of more blocks of elements and ranges of nodes than threads; under sanitizers, of a few.
std::string box(const std::string& element) {
    const int cells = test::is_sanitized ? (element == "tet" ? 9 : 12) : 21;
    const std::string n = std::to_string(cells);
    return "[mesh]\nbox = { size = [0.1, 0.1, 0.1], cells = [" + n + ", " + n + ", " + n +
           "], element = \"" + element + "\" }\n";
}

/// Sanitizers see the first half, which has cuts too.
const std::string end_time = test::is_sanitized ? "0.02" : "0.04";

const std::string held_and_pulled = R"(
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[constraint]]
name = "lid"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.04, by = [0.004, 0, 0.015] }]
[output]
interval = 0.02
checkpoint_interval = 0.02
compression = "none"
fields = ["displacement", "velocity", "mass", "stress", "J", "energy_density"]
[dynamics]
damping = 2
gravity = [0, 0, -9.81]
end_time = )" + end_time + "\n";

/// All files, without what the summary says of the number of threads. Each tool has cut.
std::map<std::string, std::string> files_of_run(const Scenario& scenario, int num_threads) {
    const RunFolder folder;
    Simulation simulation(scenario);
    simulation.set_num_threads(num_threads);
    RunWriter writer(simulation, folder / "out");
    simulation.add_observer(writer);
    run(simulation);
    writer.finish(simulation, {});
    for (const ToolSpec& tool : scenario.tools) {
        const auto& edits = simulation.edits();
        EXPECT_GE(std::count_if(edits.begin(), edits.end(),
                                [&](const EditRecord& edit) { return edit.tool == tool.name; }),
                  2)
            << tool.name;
    }
    auto files = files_of(folder / "out");
    auto summary = nlohmann::ordered_json::parse(files.at("summary.json"));
    EXPECT_EQ(summary.at("threads"), num_threads);
    summary.erase("threads");
    files["summary.json"] = summary.dump();
    return files;
}

void expect_same_in_any_number_of_threads(const std::string& text) {
    const Scenario scenario = scenario_of(text);
    const auto files = files_of_run(scenario, 1);
    EXPECT_GE(files.size(), 2u + 5u + 1u);  // frames; indexes, history, edits, summary; checkpoint
    static constexpr std::array several{7, 2, 16};
    for (const int num_threads : test::some_of(several)) {
        SCOPED_TRACE(testing::Message() << num_threads << " threads");
        expect_same(files_of_run(scenario, num_threads), files);
    }
}

TEST(RunInThreads, SplitsViscousTetrahedraToTheSameBytes) {
    expect_same_in_any_number_of_threads(box("tet") + R"([[material]]
density = 1000
young = 1000
poisson = 0.4
prony = [{ alpha = 0.4, tau = 0.02 }]
[[tool]]
kind = "blade"
name = "scalpel"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0, at = [-0.01, 0, 0] }, { time = 0.04, at = [0.06, 0, 0.01] }]
)" + held_and_pulled);
}

TEST(RunInThreads, PartsAndCarvesHexahedraToTheSameBytes) {
    expect_same_in_any_number_of_threads(box("hex") + R"([[material]]
method = "hybmss"
density = 1000
young = 1000
poisson = 0.45
[[tool]]
kind = "carver"
name = "burr"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0, at = [0.05, 0.05, 0.12] }, { time = 0.04, at = [0.05, 0.05, 0.07] }]
[[tool]]
kind = "blade"
name = "spatula"
edge = [[0, -0.1, 0.06], [0, 0.2, 0.06]]
path = [{ time = 0, at = [-0.01, 0, 0] }, { time = 0.04, at = [0.15, 0, 0.003] }]
)" + held_and_pulled);
}

}  // namespace
}  // namespace incise::runner
