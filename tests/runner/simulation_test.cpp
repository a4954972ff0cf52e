// The loop of a run: when it steps, what it reports, and what its ledger records.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "incise/base/error.h"
#include "incise/scenario/body_problems.h"
#include "incise/topology/box_mesh.h"
#include "run_folder.h"
#include "support/num_cases.h"

namespace incise::runner {
namespace {

struct Recorder : Observer {
    std::vector<double> frame_times, step_ends;
    std::vector<EditRecord> edits;

    void on_frame(const Simulation& simulation) override {
        frame_times.push_back(simulation.time());
    }
    void on_step(const Simulation& simulation) override { step_ends.push_back(simulation.time()); }
    void on_edit(const Simulation&, const EditRecord& edit) override { edits.push_back(edit); }
};

std::string message_of(const std::function<void()>& action) {
    try {
        action();
    } catch (const PhysicsError& error) {
        return error.what();
    }
    return "no PhysicsError";
}

TEST(Simulation, ReportsAllErrorsOfTheBodyAtOnce) {
    const RunFolder folder;
    const Scenario scenario = folder.scenario(R"([mesh]
box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }
[[material]]
density = 1000
young = 1000
poisson = 0.4
regions = [3]
[[constraint]]
where = { nodes = [99] }
fix = "xyz"
[[constraint]]
where = { sphere = { center = [9, 9, 9], radius = 0.01 } }
fix = "xyz"
[[load]]
where = { region = 5 }
body_force = [0, 0, 1]
[[tool]]
kind = "cut"
time = 0.01
surface = "scene.toml"
[dynamics]
end_time = 0.05
)");
    std::vector<std::string> places;
    try {
        const Simulation simulation(scenario);
    } catch (const BodyError& error) {
        const std::string file = (folder / "scene.toml").string() + ":";
        std::istringstream lines(error.what());
        for (std::string line; std::getline(lines, line);) {
            ASSERT_EQ(line.find(file), 0u) << line;
            places.push_back(line.substr(file.size(), line.find(' ', file.size()) - file.size()));
        }
    }
    EXPECT_EQ(places, (std::vector<std::string>{"3:1:", "9:9:", "12:9:", "15:9:", "20:11:"}));
}

std::string text_of(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

TEST(Simulation, RefusesMoreStepsThanWouldEverEnd) {
    const auto refusal = [](const std::string& keys, double end_time) -> std::string {
        Scenario scenario = scenario_of(soft_cube + dynamics(1, keys));
        scenario.dynamics.end_time = end_time;
        scenario.dynamics.time_step_location = "scene.toml:14:13";
        try {
            Simulation{scenario};
        } catch (const InputError& error) {
            return error.what();
        }
        return "no InputError";
    };
    EXPECT_EQ(refusal("time_step = 1e-300", 0.3),
              "scene.toml:14:13: steps of 1e-300 s would take more than 1e10 of them to the end at "
              "0.3 s: lower "
              "dynamics.end_time or raise dynamics.time_step");
    EXPECT_NE(refusal("", 1e300).find("check shape and material of element "), std::string::npos);
    EXPECT_EQ(refusal("", 0.3), "no InputError");
    // Without an end, only steps that would never make a second are refused.
    constexpr double no_end = std::numeric_limits<double>::infinity();
    EXPECT_EQ(refusal("time_step = 1e-300", no_end),
              "scene.toml:14:13: steps of 1e-300 s would take more than 1e10 of them for a second: "
              "raise dynamics.time_step");
    EXPECT_EQ(refusal("", no_end), "no InputError");
}

TEST(Simulation, FramesFallOnMultiplesUpToTheEnd) {
    struct Case {
        double interval, end_time;
        std::size_t num_frames;
    };
    // 3 * 0.3 is less than 0.9, and 3 * 0.1 more than 0.3: rounding makes no frame and no step.
    for (const auto& [interval, end_time, num_frames] :
         {Case{0.01, 0.05, 6}, Case{0.3, 0.9, 4}, Case{0.1, 0.3, 4}, Case{0.1, 0.7, 8},
          Case{0.07, 0.5, 9}, Case{0.5, 0.2, 2}, Case{0.3, 0.3, 2}, Case{0.0, 0.1, 0}})
        for (const std::string step : {"\"auto\"", "0.003"}) {
            SCOPED_TRACE(testing::Message() << interval << " of " << end_time << ", " << step);
            Scenario scenario = scenario_of(soft_cube + dynamics(1, "time_step = " + step));
            scenario.dynamics.end_time = end_time;
            scenario.output.interval = interval;
            Simulation simulation(scenario);
            Recorder recorder;
            simulation.add_observer(recorder);
            run(simulation);

            EXPECT_EQ(simulation.time(), end_time);
            ASSERT_EQ(recorder.frame_times.size(), num_frames);
            for (std::size_t i = 0; i + 1 < num_frames; ++i)
                EXPECT_EQ(recorder.frame_times[i], static_cast<double>(i) * interval);
            if (num_frames > 0) {
                EXPECT_EQ(recorder.frame_times.back(), end_time);
            }
            EXPECT_EQ(recorder.step_ends.size(), simulation.num_steps());
            double last = 0.0;
            for (const double end : recorder.step_ends) {
                EXPECT_GT(end - last, 1e-4);  // no slivers of steps
                last = end;
            }
        }
}

TEST(Simulation, AutomaticStepsFollowEditsBelowTheBound) {
    Scenario scenario = scenario_of(soft_cube + two_tools + dynamics(0.2));
    for (const double safety : {0.8, 0.3}) {
        scenario.dynamics.safety = safety;
        Simulation simulation(scenario);
        EXPECT_LE(simulation.time_step(), safety * simulation.world().stable_step());
        Recorder recorder;
        simulation.add_observer(recorder);
        simulation.start();
        double lowest = 1.0, highest = 0.0;
        while (!simulation.is_finished()) {
            const double stable = simulation.world().stable_step();
            lowest = std::min(lowest, stable);
            highest = std::max(highest, stable);
            const double next_frame = static_cast<double>(recorder.frame_times.size()) * 0.01;
            const double left = std::min(next_frame, 0.2) - simulation.time();
            simulation.step();
            EXPECT_LE(simulation.time_step(), safety * stable * (1 + 2e-9));
            // And no shorter than it takes to get to the next frame in equal steps.
            EXPECT_NEAR(simulation.time_step(),
                        left / std::ceil(left / (safety * stable) * (1 - 1e-9)), 1e-12);
        }
        EXPECT_GT(recorder.edits.size(), 2u);
        EXPECT_LT(lowest, highest);  // the edits did move the bound
    }
}

TEST(Simulation, RefusesAFixedStepAboveTheBound) {
    const Scenario automatic = scenario_of(soft_cube + dynamics(0.1, "safety = 1"));
    const double stable = Simulation(automatic).model().structure().rest_stable_step();
    Scenario scenario = automatic;
    scenario.dynamics.time_step = stable;
    EXPECT_NO_THROW(Simulation{scenario});
    scenario.dynamics.time_step = 1.5 * stable;
    const std::string message = message_of([&] { Simulation{scenario}; });
    EXPECT_NE(message.find("dynamics.time_step of " + text_of(1.5 * stable) + " s"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("stable step of " + text_of(stable) + " s"), std::string::npos)
        << message;
    EXPECT_NE(message.find("\"auto\""), std::string::npos);
}

/// A stiff, light layer (region 1) between two heavy soft ones (region 2), which slow it down until
/// a tool takes the upper one away.
std::string layered_body(const RunFolder& folder) {
    topology::MeshData mesh =
        topology::box_mesh(topology::CellKind::tetrahedron, {0, 0, 0}, {0.1, 0.1, 0.15}, {2, 2, 3});
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        double z = 0.0;
        for (const auto p : mesh.cell(c)) z += mesh.points[static_cast<std::size_t>(p)].z() / 4;
        mesh.regions[c] = z > 0.05 && z < 0.1 ? 1 : 2;
    }
    io::write_mesh(folder / "layers.vtu", mesh);
    return R"([mesh]
file = "layers.vtu"
[[material]]
regions = [1]
density = 100
young = 1000
poisson = 0.3
[[material]]
density = 10000
young = 10
poisson = 0.3
[[constraint]]
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[tool]]
kind = "carver"
shape = { box = { size = [1, 1, 0.06] } }
path = [{ time = 0.05, at = [0, 0, 0.2] }, { time = 0.1, at = [0, 0, 0.13] }]
)";
}

TEST(Simulation, RefusesFixedStepsThatEditsMakeTooLarge) {
    const RunFolder folder;
    Scenario scenario = folder.scenario(layered_body(folder) + dynamics(0.2, "time_step = 1e-6"));
    double before = 0.0, after = 0.0;
    {
        Scenario automatic = scenario;
        automatic.dynamics.time_step.reset();
        Simulation simulation(automatic);
        before = simulation.model().structure().rest_stable_step();
        run(simulation);
        after = simulation.model().structure().rest_stable_step();
    }
    ASSERT_LT(after, 0.8 * before);
    scenario.dynamics.time_step = 0.5 * (before + after);
    Simulation simulation(scenario);
    const std::string message = message_of([&] { run(simulation); });
    EXPECT_NE(message.find("dynamics.time_step of " + text_of(0.5 * (before + after)) + " s"),
              std::string::npos)
        << message;
    EXPECT_NE(message.find("that the edits have left"), std::string::npos) << message;
    EXPECT_GT(simulation.time(), 0.05);
    EXPECT_LT(simulation.time(), 0.11);
}

/// A light layer between heavy ones, of which a tool takes the upper one away or opens it up.
std::vector<std::string> warnings_of_lost_mass(const std::string& tool) {
    const RunFolder folder;
    auto layers = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                     Vec3::Constant(0.1), {2, 2, 3});
    for (std::size_t c = 0; c < layers.num_cells(); ++c) {
        double height = 0.0;
        for (const auto p : layers.cell(c))
            height += layers.points[static_cast<std::size_t>(p)].z();
        layers.regions[c] = std::abs(height / 4 - 0.05) < 0.1 / 6 ? 1 : 2;
    }
    io::write_mesh(folder / "layers.vtu", layers);
    Simulation simulation(folder.scenario(R"([mesh]
file = "layers.vtu"
[[material]]
regions = 1
density = 1
young = 1000
poisson = 0.3
[[material]]
regions = 2
density = 1e6
young = 1000
poisson = 0.3
[[constraint]]
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
)" + dynamics(0.01) + tool));
    run(simulation);
    return simulation.warnings();
}

TEST(Simulation, WarnsOfShortStepsWithTheToolsKeys) {
    for (const auto& [tool, remedy] : {std::pair(R"([[tool]]
name = "saw"
kind = "carver"
shape = { box = { size = [1, 1, 0.034] } }
path = [{ time = 0.005, at = [0.05, 0.05, 0.0835] }]
)",
                                                 "change tool.shape or tool.path"),
                                       std::pair(R"([[tool]]
name = "saw"
kind = "blade"
mode = "separate"
edge = [[0, -1, 0.067], [0, 1, 0.067]]
path = [{ time = 0, at = [-0.1, 0, 0] }, { time = 0.005, at = [0.2, 0, 0] }]
)",
                                                 "change tool.edge or tool.path")}) {
        SCOPED_TRACE(tool);
        auto warnings = warnings_of_lost_mass(tool);
        // The densities are so far apart that both are doubted.
        std::erase_if(warnings, [](const std::string& warning) {
            return warning.find("has a density of") != std::string::npos;
        });
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_TRUE(warnings[0].starts_with("tool 'saw', at t = ")) << warnings[0];
        EXPECT_NE(warnings[0].find("has left stiff elements with so little mass that the stable "
                                   "step fell from "),
                  std::string::npos)
            << warnings[0];
        EXPECT_NE(warnings[0].find(remedy), std::string::npos) << warnings[0];
        EXPECT_EQ(warnings[0].find("snap"), std::string::npos) << warnings[0];
    }
}

TEST(Simulation, RepeatedEndsInTheSameBits) {
    const RunFolder folder;
    const Scenario scenario =
        folder.scenario(soft_cube + two_tools + dynamics(0.2, "gravity = [0, 0, -9.81]"));
    run(scenario, folder / "one");
    run(scenario, folder / "two");
    std::size_t num_files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "one")) {
        if (!entry.is_regular_file()) continue;
        const auto name = std::filesystem::relative(entry.path(), folder / "one");
        if (name == "summary.json") continue;  // it tells the wall time
        EXPECT_EQ(support::read_text(entry.path()), support::read_text(folder / "two" / name))
            << name;
        ++num_files;
    }
    EXPECT_EQ(num_files, 21u + 5u + 2u);  // frames; scenario, indexes, history, edits; checkpoints
}

/// Where surfaces meet, small differences grow, and the balance of energy is less exact.
const std::string no_contact = "[contact]\nenabled = false\n";

TEST(Simulation, InSinglePrecisionEndsNearDoublePrecision) {
    for (const std::string method :
         {"law = \"saint-venant-kirchhoff\"", "prony = [{ alpha = 0.3, tau = 0.05 }]"}) {
        SCOPED_TRACE(method);
        std::string body = soft_cube;
        body.replace(body.find("[[material]]"), 12, "[[material]]\n" + method);
        const auto run_in = [&](const std::string& precision) {
            auto simulation = std::make_unique<Simulation>(scenario_of(
                body + no_contact +
                dynamics(0.2, "gravity = [0, 0, -9.81]\nprecision = \"" + precision + "\"")));
            run(*simulation);
            return simulation;
        };
        const auto expected = run_in("double"), single = run_in("single");
        EXPECT_NE(expected->model().positions()[40], single->model().positions()[40]);
        const double moved = expected->model().max_displacement();
        EXPECT_GT(moved, 0.005);
        for (std::size_t n = 0; n < expected->mesh().node_capacity(); ++n)
            EXPECT_LE((expected->model().positions()[n] - single->model().positions()[n]).norm(),
                      1e-5 * moved);
        EXPECT_NEAR(single->ledger().energy_error(), expected->ledger().energy_error(), 1e-5);
    }
}

TEST(Ledger, AccountsForEveryEdit) {
    const Scenario scenario = scenario_of(
        soft_cube + two_tools +
        dynamics(0.2, "gravity = [0, 0, -9.81]\ntime_step = 0.0055"));  // both cut in some steps
    Simulation simulation(scenario);
    Recorder recorder;
    simulation.add_observer(recorder);
    run(simulation);
    const auto& edits = simulation.edits();
    ASSERT_EQ(recorder.edits.size(), edits.size());
    EXPECT_LE(simulation.ledger().mass_error(), 1e-12);

    std::size_t removed = 0, opened = 0;
    double mass_removed = 0.0;
    const BodyTotals* last = &simulation.ledger().initial();
    std::size_t num_in_same_step = 0;
    std::uint64_t step = 0;
    for (const EditRecord& edit : edits) {
        SCOPED_TRACE(testing::Message() << edit.tool << " at " << edit.time);
        EXPECT_TRUE(edit.tool == "burr" || edit.tool == "knife");
        // Nothing comes or goes between edits.
        EXPECT_EQ(edit.before.nodes, last->nodes);
        EXPECT_EQ(edit.before.elements, last->elements);
        EXPECT_EQ(edit.before.components, last->components);
        EXPECT_EQ(edit.before.totals.mass, last->totals.mass);
        EXPECT_EQ(edit.before.totals.rest_volume, last->totals.rest_volume);
        EXPECT_EQ(edit.before.stable_step, last->stable_step);
        // Between those of one step nothing moves either, and else all does.
        const bool is_in_same_step = edit.step == step;
        num_in_same_step += is_in_same_step;
        EXPECT_EQ(edit.before.totals.kinetic_energy == last->totals.kinetic_energy,
                  is_in_same_step);
        EXPECT_EQ(edit.before.totals.elastic_energy == last->totals.elastic_energy,
                  is_in_same_step);
        step = edit.step;
        last = &edit.after;

        EXPECT_EQ(edit.after.elements + edit.elements_removed, edit.before.elements);
        EXPECT_EQ(edit.after.nodes + edit.nodes_removed, edit.before.nodes + edit.nodes_added);
        EXPECT_NEAR(edit.before.totals.mass - edit.after.totals.mass, edit.mass_removed, 1e-15);
        EXPECT_NEAR(edit.mass_removed,
                    1000 * (edit.before.totals.rest_volume - edit.after.totals.rest_volume), 1e-15);
        if (edit.tool == "burr") {
            EXPECT_GT(edit.elements_removed, 0u);
            EXPECT_EQ(edit.faces_opened, 0u);
        } else {
            // Separation takes nothing away.
            EXPECT_EQ(edit.elements_removed, 0u);
            EXPECT_GT(edit.faces_opened, 0u);
            EXPECT_EQ(edit.after.totals.elastic_energy, edit.before.totals.elastic_energy);
            EXPECT_NEAR(edit.after.totals.kinetic_energy / edit.before.totals.kinetic_energy, 1.0,
                        1e-12);
            const double p = edit.before.totals.momentum.norm(),
                         l = edit.before.totals.angular_momentum.norm();
            EXPECT_LE((edit.after.totals.momentum - edit.before.totals.momentum).norm(), 1e-12 * p);
            EXPECT_LE(
                (edit.after.totals.angular_momentum - edit.before.totals.angular_momentum).norm(),
                1e-12 * l);
        }
        removed += edit.elements_removed;
        opened += edit.faces_opened;
        mass_removed += edit.mass_removed;
    }
    EXPECT_EQ(removed + simulation.mesh().num_elements(), 162u);
    EXPECT_GT(removed, 3u);
    EXPECT_GT(opened, 5u);
    EXPECT_GT(num_in_same_step, 0u);
    EXPECT_NEAR(mass_removed + simulation.model().energetics().totals().mass, 1.0, 1e-12);
    EXPECT_GE(edits.back().after.components, 2);
}

TEST(Ledger, EnergyErrorIsOfTheOrderOfSteps) {
    // The grip sets off and stops with a jump of its velocity.
    const std::string moved = R"(
[[constraint]]
name = "grip"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.2, by = [0.01, 0, 0.02] }]
)";
    const std::string gravity = "gravity = [0, 0, -2]\n";
    std::string viscous_cube = soft_cube;
    viscous_cube.insert(viscous_cube.find("poisson"),
                        "prony = [{ alpha = 0.3, tau = 0.05 }, { alpha = 0.3, tau = 1 }]\n");
    std::string nodal_cube = viscous_cube;
    nodal_cube.insert(nodal_cube.find("prony"), "prony_rule = \"nodal\"\n");
    const std::vector<std::pair<std::string, std::string>> cases{
        {"viscous by nodes, cut", nodal_cube + no_contact + two_tools + dynamics(0.5, gravity)},
        {"undamped", soft_cube + dynamics(0.5, gravity)},
        {"damped", soft_cube + dynamics(0.5, gravity + "damping = 5")},
        {"moved", soft_cube + moved + dynamics(0.5, gravity)},
        {"moved and damped", soft_cube + moved + dynamics(0.5, gravity + "damping = 5")},
        {"viscous", viscous_cube + dynamics(0.5, gravity)},
        {"viscous, moved", viscous_cube + moved + dynamics(0.5, gravity)},
        {"viscous by nodes, moved", nodal_cube + moved + dynamics(0.5, gravity)},
        {"viscous, cut", viscous_cube + no_contact + two_tools + dynamics(0.5, gravity)},
        {"cut", soft_cube + no_contact + two_tools + dynamics(0.5, gravity + "damping = 5")}};
    for (const auto& [name, text] : test::some_of(cases)) {
        Scenario scenario = scenario_of(text);
        std::vector<double> errors;
        for (const double safety : {0.8, 0.1}) {
            scenario.dynamics.safety = safety;
            Simulation simulation(scenario);
            run(simulation);
            errors.push_back(simulation.ledger().energy_error());
        }
        EXPECT_LT(errors[0], 0.02) << name;
        EXPECT_LT(errors[1], 0.25 * errors[0]) << name;  // an eighth of the step
    }
}

TEST(Simulation, GoesOnWhenNothingIsLeft) {
    Simulation simulation(scenario_of(soft_cube + R"(
[[tool]]
kind = "carver"
shape = { sphere = { radius = 1 } }
path = [{ time = 0.05, at = [0, 0, 0] }, { time = 0.06, at = [0, 0, 0] }]
)" + dynamics(0.1, "gravity = [0, 0, -9.81]")));
    Recorder recorder;
    simulation.add_observer(recorder);
    run(simulation);
    EXPECT_EQ(simulation.mesh().num_elements(), 0u);
    EXPECT_EQ(simulation.mesh().num_nodes(), 0u);
    EXPECT_EQ(recorder.edits.size(), 1u);
    EXPECT_EQ(recorder.frame_times.size(), 11u);
    EXPECT_LE(simulation.ledger().mass_error(), 1e-12);
    EXPECT_EQ(simulation.model().energetics().totals().mass, 0.0);
}

TEST(Simulation, StopsWhenTheMotionBlowsUp) {
    Simulation simulation(scenario_of(soft_cube + R"(
[[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0.02, by = [0, 0, 0] }, { time = 0.021, by = [0, 0, 50] }]
)" + dynamics(0.1)));
    const std::string message = message_of([&] { run(simulation); });
    EXPECT_EQ(message.find("element "), 0u) << message;
    EXPECT_NE(message.find(", node "), std::string::npos);
    EXPECT_NE(message.find("its constraint moves too fast"), std::string::npos);
    EXPECT_GE(simulation.time(), 0.01);
    EXPECT_LT(simulation.time(), 0.03);
}

}  // namespace
}  // namespace incise::runner
