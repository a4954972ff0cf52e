// Runs that are stopped and go on from a checkpoint: the same bytes in every file, and the same
// state, as of the run that was never stopped.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <gtest/gtest.h>

#include <functional>

#include "incise/base/error.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/runner/frame_builder.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/validate.h"
#include "run_folder.h"
#include "support/mesh_families.h"
#include "support/run_files.h"

namespace incise::runner {
namespace {

namespace fs = std::filesystem;
using support::expect_same;
using support::files_of;
using support::read_text;

std::string state_of(const Simulation& simulation) {
    ArchiveWriter ar;
    simulation.save(ar);
    for (const std::string& warning : simulation.warnings()) ar(warning);
    return ar.bytes();
}

/// Runs to `stop` steps, takes a checkpoint there, and leaves.
void run_to(const Scenario& scenario, const fs::path& folder, std::uint64_t stop) {
    Simulation simulation(scenario);
    RunWriter writer(simulation, folder);
    simulation.add_observer(writer);
    simulation.start();
    while (simulation.num_steps() < stop) simulation.step();
    writer.take_checkpoint(simulation, CheckpointKind::of_a_stop);
}

/// Goes on to the end; returns what it has at the end.
std::string resume(const Scenario& scenario, const fs::path& folder,
                   std::vector<std::string>* warnings = nullptr) {
    io::OutputFolder ours(folder);
    std::vector<std::string> told;
    const Checkpoint checkpoint = Checkpoint::newest(folder, warnings ? *warnings : told);
    Simulation simulation(scenario);
    checkpoint.restore(simulation);
    EXPECT_EQ(topology::validate(simulation.mesh()), std::vector<std::string>{});
    RunWriter writer(simulation, std::move(ours), checkpoint.written());
    simulation.add_observer(writer);
    while (!simulation.is_finished()) simulation.step();
    writer.finish(simulation, {});
    return state_of(simulation);
}

/// Stops the run of this text at several of its steps, with every edit among the moments of
/// stopping if there are few, and goes on each time.
void expect_resumable(const RunFolder& folder, const std::string& text,
                      std::size_t least_edits = 2) {
    const Scenario scenario = folder.scenario(text);
    Simulation whole(scenario);
    std::vector<std::uint64_t> stops{0, 1};
    {
        RunWriter writer(whole, folder / "whole");
        whole.add_observer(writer);
        run(whole);
        writer.finish(whole, {});
    }
    // After the first edits, in the middle of them, before and after the last one.
    const auto& edits = whole.edits();
    ASSERT_GE(edits.size(), least_edits);
    if (!edits.empty())
        for (const std::uint64_t step :
             {edits.front().step, edits[edits.size() / 3].step, edits[edits.size() / 2].step,
              edits.back().step - 1, edits.back().step})
            stops.push_back(step);
    stops.push_back(whole.num_steps() - 1);
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    std::erase_if(stops, [&](std::uint64_t step) { return step >= whole.num_steps(); });
    const auto files = files_of(folder / "whole");
    const std::string end = state_of(whole);
    for (const std::uint64_t stop : stops) {
        SCOPED_TRACE(testing::Message() << "stopped after step " << stop);
        run_to(scenario, folder / "stopped", stop);
        EXPECT_TRUE(resume(scenario, folder / "stopped") == end) << "another state at the end";
        expect_same(files_of(folder / "stopped"), files);
    }
}

const std::string pulled_lid = R"(
[[constraint]]
name = "lid"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.1, by = [0.005, 0, 0.02] }]
rotate = [{ time = 0, angle = 0 }, { time = 0.1, angle = 0.2 }]
about = { point = [0.05, 0.05, 0.1], axis = [0, 0, 1] }
)";

/// Goes in from one side, stops, and comes back at a slant: its front is long in the body.
const std::string splitting_blade = R"(
[[tool]]
kind = "blade"
name = "scalpel"
edge = [[0, -0.1, 0.05], [0, 0.03, 0.053], [0, 0.2, 0.058]]
path = [{ time = 0.01, at = [-0.02, 0, 0] }, { time = 0.06, at = [0.06, 0, 0.01] },
        { time = 0.08, at = [0.03, 0, 0.02] }]
)";

const std::string output = "[output]\ninterval = 0.04\ncompression = \"none\"\n";

TEST(ResumedRun, GoesOnWithABodyReadFromACutFrame) {
    const RunFolder folder;
    const std::string tools = R"(
[[tool]]
kind = "cut"
time = 0.02
plane = { point = [0.05, 0.045, 0.05], normal = [0.1, 1, 0.3] }
[[tool]]
kind = "blade"
edge = [[0.047, -0.1, 0], [0.052, 0.2, 0.004]]
path = [{ time = 0.01, at = [0, 0, 0.12] }, { time = 0.03, at = [0, 0, 0.041] }]
)";
    Simulation written(folder.scenario(soft_cube + tools + dynamics(0.03)));
    run(written);
    io::write_vtu(folder / "frame.vtu", build_frame(written.model(), written.time(), {}));
    const std::string read =
        "[mesh]\nfile = \"frame.vtu\"\n" + soft_cube.substr(soft_cube.find("[[material]]"));
    expect_resumable(folder, read + splitting_blade + dynamics(0.1));
}

TEST(ResumedRun, EqualsOneNeverStoppedWithASplittingBlade) {
    const RunFolder folder;
    expect_resumable(folder,
                     soft_cube + pulled_lid + splitting_blade + three_loads + output +
                         dynamics(0.1, "gravity = [0, 0, -9.81]\ndamping = 2\nsafety = 0.1\n"),
                     3);
}

TEST(ResumedRun, EqualsOneNeverStoppedWithSeveralTools) {
    const RunFolder folder;
    // The blade cuts what the plane and the burr have left, and along its own earlier way.
    expect_resumable(folder, soft_cube + two_tools + splitting_blade + R"(
[[tool]]
kind = "cut"
time = 0.04
plane = { point = [0, 0.043, 0.05], normal = [0.1, 1, 0.1] }
)" + output + dynamics(0.12, "gravity = [0, 0, -9.81]\nsafety = 0.3\n"),
                     6);
}

TEST(ResumedRun, EqualsOneNeverStoppedWithViscosity) {
    for (const char* rule : {"stress", "nodal"}) {
        SCOPED_TRACE(rule);
        const RunFolder folder;
        std::string text = soft_cube;
        text.replace(text.find("[[constraint]]"), 0,
                     "prony = [{ alpha = 0.4, tau = 0.02 }, { alpha = 0.2, tau = 0.3 }]\n"
                     "prony_rule = \"" +
                         std::string(rule) + "\"\n");
        expect_resumable(folder, text + pulled_lid + splitting_blade + output + dynamics(0.08));
    }
}

TEST(ResumedRun, EqualsOneNeverStoppedWithMeshFibres) {
    const RunFolder folder;
    io::Frame frame;
    frame.mesh = topology::box_mesh(topology::CellKind::tetrahedron, Vec3::Zero(),
                                    Vec3::Constant(0.1), {3, 3, 3});
    std::vector<double> vectors;
    for (std::size_t c = 0; c < frame.mesh.num_cells(); ++c)
        vectors.insert(vectors.end(), {0.5, std::sin(static_cast<double>(c)), 2.0});
    frame.cell_fields.push_back({"collagen", 3, vectors});
    io::write_vtu(folder / "body.vtu", frame);
    const std::string text =
        "[mesh]\nfile = \"body.vtu\"\n"
        R"([[material]]
law = "holzapfel-gasser-ogden"
density = 1000
shear_modulus = 400
bulk_modulus = 2000
k1 = 1000
k2 = 0.5
fibre_array = "collagen"
)" + soft_cube.substr(soft_cube.find("[[constraint]]")) +
        pulled_lid + splitting_blade + output + dynamics(0.08);
    expect_resumable(folder, text);

    // Other fibres, another body.
    run_to(folder.scenario(text), folder / "changed", 3);
    std::get<std::vector<double>>(frame.cell_fields[0].values)[0] += 0.1;
    io::write_vtu(folder / "body.vtu", frame);
    EXPECT_THROW(resume(folder.scenario(text), folder / "changed"), InputError);
}

TEST(ResumedRun, EqualsOneNeverStoppedOfHexahedra) {
    const RunFolder folder;
    expect_resumable(folder, R"(
[mesh]
box = { size = [0.1, 0.1, 0.1], cells = [6, 6, 6], element = "hex" }
[[material]]
method = "hybmss"
density = 1000
young = 1000
poisson = 0.45
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
)" + two_tools + output + dynamics(0.16, "gravity = [0, 0, -9.81]\nsafety = 0.3\n"));
}

TEST(ResumedRun, EqualsOneNeverStoppedByImplicitSteps) {
    const RunFolder folder;
    expect_resumable(folder, soft_cube + pulled_lid + splitting_blade + output +
                                 dynamics(0.1,
                                          "integrator = \"implicit-euler\"\ntime_step = 0.01\n"
                                          "gravity = [0, 0, -9.81]\n"));
}

TEST(ResumedRun, EqualsOneNeverStoppedInStatics) {
    const RunFolder folder;
    // The piece that is cut off and led by the lid's sliding alone can move: it is pinned where it
    // was when the cut had been made.
    const std::string sliding_lid = R"(
[[constraint]]
name = "lid"
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
fix = "z"
move = [{ time = 0, by = [0, 0, 0] }, { time = 0.2, by = [0, 0, 0.02] }]
[[tool]]
kind = "cut"
time = 0.05
plane = { point = [0, 0, 0.05], normal = [0.2, 0.1, 1] }
)";
    expect_resumable(
        folder, soft_cube + sliding_lid + output + dynamics(0.2, "mode = \"static\"\nsteps = 10\n"),
        1);
}

TEST(ResumedRun, EqualsOneNeverStoppedWithoutFrames) {
    const RunFolder folder;
    expect_resumable(folder, soft_cube + two_tools +
                                 "[output]\ninterval = 0\ncheckpoint_interval = 0\n" +
                                 dynamics(0.12, "gravity = [0, 0, -9.81]\n"));
}

class Resume : public testing::Test {
  protected:
    /// Leaves after step 10, with the last two of several checkpoints.
    void stop() {
        Simulation simulation(scenario_);
        RunWriter writer(simulation, folder_ / "out");
        simulation.add_observer(writer);
        simulation.start();
        while (simulation.num_steps() < 10) simulation.step();
    }
    /// In the order of their steps.
    std::vector<fs::path> checkpoints() {
        std::vector<fs::path> found;
        for (const auto& entry : fs::directory_iterator(folder_ / "out/checkpoints"))
            found.push_back(entry.path());
        std::sort(found.begin(), found.end());
        return found;
    }
    std::string error_of(const std::function<void()>& function) {
        try {
            function();
        } catch (const InputError& error) {
            return error.what();
        }
        return "no error";
    }

    const std::string text_ = soft_cube + splitting_blade + output +
                              "checkpoint_interval = 0.007\n" +
                              dynamics(0.05, "gravity = [0, 0, -9.81]\nsafety = 0.3\n");
    RunFolder folder_;
    Scenario scenario_ = folder_.scenario(text_);
};

TEST_F(Resume, KeepsTheLastTwoCheckpointsReproducibly) {
    stop();
    const auto kept = checkpoints();
    ASSERT_EQ(kept.size(), 2u);
    EXPECT_FALSE(kept[0].filename().string().ends_with("_000000000000.checkpoint"));
    const std::string before = read_text(kept[0]), last = read_text(kept[1]);
    stop();
    EXPECT_EQ(checkpoints(), kept);
    EXPECT_TRUE(read_text(kept[0]) == before);
    EXPECT_TRUE(read_text(kept[1]) == last);
}

TEST_F(Resume, TakesTheCheckpointBeforeADamagedOne) {
    run(scenario_, folder_ / "whole");
    const auto whole = files_of(folder_ / "whole");
    stop();
    const auto kept = checkpoints();
    ASSERT_EQ(kept.size(), 2u);
    const std::string good = read_text(kept[1]);
    std::vector<std::string> damages{"", good.substr(0, good.size() / 2),
                                     good.substr(0, good.size() - 1)};
    test::Random random(7);
    for (int i = 0; i < 2; ++i) {
        damages.push_back(good);
        damages.back()[random.below(good.size())] ^= static_cast<char>(1 << random.below(8));
    }
    for (std::size_t i = 0; i < damages.size(); ++i) {
        SCOPED_TRACE(i);
        stop();
        io::write_file(kept[1], damages[i]);
        std::vector<std::string> warnings;
        resume(scenario_, folder_ / "out", &warnings);
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_EQ(warnings[0].find(kept[1].string() + ": "), 0u) << warnings[0];
        EXPECT_NE(warnings[0].find("trying the checkpoint before it"), std::string::npos);
        expect_same(files_of(folder_ / "out"), whole);
    }
    stop();
    io::write_file(kept[1], "");
    io::write_file(kept[0], good.substr(1));
    EXPECT_NE(error_of([&] { resume(scenario_, folder_ / "out"); }).find("no whole checkpoint"),
              std::string::npos);
}

TEST_F(Resume, RemovesOnlyDamagedCheckpointsThatItSkips) {
    stop();
    const auto kept = checkpoints();
    ASSERT_EQ(kept.size(), 2u);
    const auto add_strays = [&] {
        for (const char* name : {"step_999999999999.checkpoint", "stop_999999999999.checkpoint"})
            io::write_file(folder_ / "out/checkpoints" / name, "");
    };
    add_strays();
    const auto not_ours = folder_ / "out/checkpoints/step_x.checkpoint";
    io::write_file(not_ours, "");
    const std::string good = read_text(kept[0]);
    io::write_file(kept[1], good.substr(1));
    io::OutputFolder ours(folder_ / "out");
    std::vector<std::string> warnings;
    const Checkpoint checkpoint = Checkpoint::newest(folder_ / "out", warnings);
    ASSERT_EQ(warnings.size(), 3u);
    for (const auto& warning : warnings)
        EXPECT_TRUE(warning.ends_with("; if the run goes on from there, this one is removed"));
    EXPECT_EQ(checkpoints().size(), 5u);  // nothing is changed yet
    Simulation simulation(scenario_);
    checkpoint.restore(simulation);
    RunWriter writer(simulation, std::move(ours), checkpoint.written());
    EXPECT_EQ(checkpoints(), (std::vector{kept[0], not_ours}));
    simulation.add_observer(writer);
    simulation.step();
    add_strays();
    writer.take_checkpoint(simulation, CheckpointKind::regular);
    EXPECT_EQ(checkpoints().size(), 3u);
    EXPECT_TRUE(read_text(kept[0]) == good);
}

TEST_F(Resume, LeavesTheCheckpointsOfAnUnstoppedRun) {
    run(scenario_, folder_ / "whole");
    const auto whole = files_of(folder_ / "whole");
    Simulation counted(scenario_);
    run(counted);
    const auto num_regular = [&] {
        const auto all = checkpoints();
        return std::count_if(all.begin(), all.end(), [](const fs::path& path) {
            return path.filename().string().starts_with("step_");
        });
    };
    // At every step, also in the last intervals, and right after a regular one.
    for (std::uint64_t step = 0; step < counted.num_steps(); ++step) {
        SCOPED_TRACE(step);
        run_to(scenario_, folder_ / "out", step);
        const auto regular = num_regular();
        EXPECT_GE(regular, 1);
        EXPECT_LE(checkpoints().size(), 3u);
        // Stopped once more, before it has gone on and one step later.
        for (int steps = 0; steps < 2; ++steps) {
            io::OutputFolder ours(folder_ / "out");
            std::vector<std::string> warnings;
            const Checkpoint checkpoint = Checkpoint::newest(folder_ / "out", warnings);
            Simulation simulation(scenario_);
            checkpoint.restore(simulation);
            ASSERT_EQ(simulation.num_steps(), step);
            RunWriter writer(simulation, std::move(ours), checkpoint.written());
            simulation.add_observer(writer);
            for (int i = 0; i < steps; ++i) simulation.step();
            if (!simulation.is_finished())
                writer.take_checkpoint(simulation, CheckpointKind::of_a_stop);
            EXPECT_GE(num_regular(), regular);
        }
        resume(scenario_, folder_ / "out");
        expect_same(files_of(folder_ / "out"), whole);
    }
}

TEST_F(Resume, RefusesAnotherScenarioAndNamesWhatDiffers) {
    stop();
    const auto before = read_text(folder_ / "out/history.csv");
    const auto refusal = [&](const std::string& text) {
        const Scenario other = folder_.scenario(text);
        return error_of([&] { resume(other, folder_ / "out"); });
    };
    std::string harder = text_;
    harder.replace(harder.find("young = 1000"), 12, "young = 1500");
    EXPECT_NE(refusal(harder).find("material[0].young was 1000 and is 1500; "), std::string::npos);
    EXPECT_NE(
        refusal(text_ + "damping = 0.7\n").find("dynamics.damping was not given and is 0.7; "),
        std::string::npos);
    std::string coarser = text_;
    coarser.replace(coarser.find("[3, 3, 3]"), 9, "[2, 3, 3]");
    EXPECT_NE(refusal(coarser).find("mesh.box.cells was [3, 3, 3] and is [2, 3, 3]"),
              std::string::npos);
    EXPECT_EQ(read_text(folder_ / "out/history.csv"), before);  // nothing has been touched
    EXPECT_EQ(refusal("# a comment\n" + text_), "no error");
}

TEST_F(Resume, RefusesMissingFilesAndTouchesNothing) {
    const auto refusal = [&](const std::function<void()>& harm) {
        stop();
        harm();
        const auto text = error_of([&] { resume(scenario_, folder_ / "out"); });
        EXPECT_TRUE(fs::exists(folder_ / "out/scene.pvd"));
        return text;
    };
    EXPECT_NE(refusal([&] {
                  fs::resize_file(folder_ / "out/history.csv", 20);
              }).find("history.csv: has become shorter"),
              std::string::npos);
    EXPECT_NE(
        refusal([&] { fs::remove(folder_ / "out/edits.jsonl"); }).find("edits.jsonl: has gone"),
        std::string::npos);
    EXPECT_NE(refusal([&] {
                  fs::remove(folder_ / "out/frames/scene_000000.vtu");
              }).find("scene_000000.vtu"),
              std::string::npos);
}

TEST_F(Resume, FindsNoCheckpointOfANewRun) {
    stop();
    {
        Simulation simulation(scenario_);
        RunWriter writer(simulation, folder_ / "out");
        EXPECT_THROW(RunWriter(simulation, folder_ / "out"), InputError);  // in use
    }
    EXPECT_NE(error_of([&] { resume(scenario_, folder_ / "out"); }).find("no checkpoint"),
              std::string::npos);
}

TEST_F(Resume, ContinuesRowsOfARunThatFailsLater) {
    // The lid is torn away after the stop: the summary of the failure tells the last row.
    const std::string text = text_ + R"([[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0.03, by = [0, 0, 0] }, { time = 0.031, by = [0, 0, 500] }]
)";
    const Scenario scenario = folder_.scenario(text);
    const auto fail = [&](Simulation& simulation, RunWriter& writer) {
        simulation.add_observer(writer);
        if (simulation.num_steps() == 0) simulation.start();
        EXPECT_THROW(while (!simulation.is_finished()) simulation.step(), PhysicsError);
        writer.finish(simulation, {"failed", "torn"});
    };
    {
        Simulation simulation(scenario);
        RunWriter writer(simulation, folder_ / "whole");
        fail(simulation, writer);
    }
    // With a checkpoint right before the step that fails.
    std::uint64_t stop = 0;
    {
        Simulation simulation(scenario);
        simulation.start();
        EXPECT_THROW(
            while (true) {
                simulation.step();
                stop = simulation.num_steps();
            },
            PhysicsError);
    }
    run_to(scenario, folder_ / "out", stop);
    std::vector<std::string> warnings;
    const Checkpoint checkpoint = Checkpoint::newest(folder_ / "out", warnings);
    Simulation simulation(scenario);
    checkpoint.restore(simulation);
    RunWriter writer(simulation, io::OutputFolder(folder_ / "out"), checkpoint.written());
    fail(simulation, writer);
    expect_same(files_of(folder_ / "out"), files_of(folder_ / "whole"));
}

}  // namespace
}  // namespace incise::runner
