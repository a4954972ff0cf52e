// Runs of small bodies, as a test writes them down, in a folder of their own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "incise/io/mesh/mesh_writer.h"
#include "incise/runner/run_writer.h"
#include "incise/runner/simulation.h"
#include "incise/scenario/scenario_reader.h"
#include "support/temporary_folder.h"

namespace incise::runner {

using namespace sim;
using namespace scenario;

/// A soft cube of 0.1 m in 162 tetrahedra, held at its bottom. Its stable step is some
/// milliseconds.
inline const std::string soft_cube = R"(
[mesh]
box = { size = [0.1, 0.1, 0.1], cells = [3, 3, 3] }
[[material]]
density = 1000
young = 1000
poisson = 0.4
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
)";

/// A ball that goes down through the middle of the cube, and a blade that then goes along x.
inline const std::string two_tools = R"(
[[tool]]
kind = "carver"
name = "burr"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0, at = [0.05, 0.05, 0.13] }, { time = 0.1, at = [0.05, 0.05, 0.07] }]
[[tool]]
kind = "blade"
name = "knife"
mode = "separate"
edge = [[0, -0.1, 0.06], [0, 0.2, 0.06]]
path = [{ time = 0.05, at = [-0.05, 0, 0] }, { time = 0.15, at = [0.15, 0, 0.003] }]
)";

/// On three nodes, on a side and on the upper half of a cube of 10 cm.
inline const std::string three_loads = R"(
[[load]]
where = { nodes = [60, 61, 62] }
nodal_force = [0.002, 0, 0]
[[load]]
where = { half_space = { point = [0.1, 0, 0], normal = [1, 0, 0] } }
pressure = 20
factor = [{ time = 0, value = 0 }, { time = 0.1, value = 1 }]
[[load]]
where = { half_space = { point = [0, 0, 0.05], normal = [0, 0, 1] } }
body_force = [0, 30, 0]
)";

inline std::string dynamics(double end_time, const std::string& more = "") {
    return "[dynamics]\nend_time = " + std::to_string(end_time) + "\n" + more;
}

class RunFolder {
  public:
    /// The scenario of this text, which must have no errors.
    Scenario scenario(const std::string& text) const {
        const auto path = folder_ / "scene.toml";
        std::ofstream(path) << text;
        ScenarioReport report = read_scenario(path);
        EXPECT_EQ(report.errors, std::vector<std::string>{});
        return std::move(report.scenario);
    }
    /// What reading this text reports.
    ScenarioReport report(const std::string& text) const {
        const auto path = folder_ / "scene.toml";
        std::ofstream(path) << text;
        return read_scenario(path);
    }
    std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

  private:
    support::TemporaryFolder folder_;
};

inline Scenario scenario_of(const std::string& text) { return RunFolder().scenario(text); }

/// Steps to the end.
inline void run(Simulation& simulation) {
    simulation.start();
    while (!simulation.is_finished()) simulation.step();
}

/// Runs to the end and leaves all files in `folder`.
inline void run(const Scenario& scenario, const std::filesystem::path& folder) {
    Simulation simulation(scenario);
    RunWriter writer(simulation, folder);
    simulation.add_observer(writer);
    run(simulation);
    writer.finish(simulation, {});
}

}  // namespace incise::runner
