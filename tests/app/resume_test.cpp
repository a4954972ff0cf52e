// Runs that are stopped by signals, kills, full disks and failing calls of the system, and resumed:
// the same bytes in every file as those of a run that nothing happened to.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cerrno>

#include "run_process.h"
#include "support/mesh_families.h"
#include "support/run_files.h"

namespace incise::test {
namespace {

using support::expect_same;
using support::files_of;

/// A blade that divides what the burr of `scene` leaves.
const std::string cut_scene = scene + R"([[tool]]
kind = "blade"
edge = [[0, -0.1, 0.03], [0, 0.2, 0.034]]
path = [{ time = 0.005, at = [-0.01, 0, 0] }, { time = 0.045, at = [0.09, 0, 0.003] }]
[output]
interval = 0.01
checkpoint_interval = 0.02
compression = "none"
)";

class ResumedProcess : public Run {
  protected:
    /// What a run that nothing happens to leaves.
    std::map<std::string, std::string> whole(const std::string& text) {
        write("scene.toml", text);
        EXPECT_EQ(run({"scene.toml", "--quiet", "--out", "whole"}).status, 0);
        return files_of(folder_ / "whole");
    }
    bool has_checkpoint() {
        const auto path = folder_ / "scene.out/checkpoints";
        if (fs::exists(path))
            for (const auto& entry : fs::directory_iterator(path))
                if (entry.path().extension() == ".checkpoint") return true;
        return false;
    }
    /// Goes on, or begins anew if the run had not come to its first checkpoint.
    void expect_to_end_as(const std::map<std::string, std::string>& files) {
        std::vector<std::string> arguments{"scene.toml", "--quiet"};
        if (has_checkpoint() || fs::exists(folder_ / "scene.out/summary.json"))
            arguments.push_back("--resume");
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        EXPECT_EQ(outcome.err, "");
        EXPECT_EQ(outcome.out, "scene.out/scene.pvd\n");
        expect_same(files_of(folder_ / "scene.out"), files);
    }
    /// Calls that change files of a run with such a fault, if it does not happen.
    std::size_t num_calls(const std::string& fault) {
        EXPECT_EQ(run({"scene.toml", "--quiet", "--out", "counted"},
                      with_fault(fault, 0, (folder_ / "count").string()))
                      .status,
                  0);
        return std::stoul(read_text(folder_ / "count"));
    }
    Environment with_fault(const std::string& fault, std::size_t at,
                           const std::string& count = "") {
        Environment environment{{"LD_PRELOAD", INCISE_FAULTS},
                                {"INCISE_FAULT", fault},
                                {"INCISE_FAULT_AT", std::to_string(at)}};
        if (!count.empty()) environment.emplace_back("INCISE_FAULT_COUNT", count);
        return environment;
    }
    Environment with_fault_of_opening(int error, std::size_t at, const std::string& count = "") {
        auto environment = with_fault(std::to_string(error), at, count);
        environment.emplace_back("INCISE_FAULT_OPEN", "");
        return environment;
    }
};

TEST_F(ResumedProcess, EndsAsIfNoSignalHadStoppedIt) {
    const std::string text = endless + "checkpoint_interval = 0\n";
    write("scene.toml", text);
    const std::vector<std::string> arguments{
        "scene.toml", "--quiet", "--set", "material[0].young=1.5e3", "--end-time", "0.15"};
    ASSERT_EQ(run({"scene.toml", "--quiet", "--set", "material[0].young=1.5e3", "--end-time",
                   "0.15", "--out", "whole"})
                  .status,
              0);
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove_all(folder_ / "scene.out");
        const pid_t child = start(arguments);
        wait_for_frame(4);
        ::kill(child, signal);
        auto outcome = finish(child);
        ASSERT_EQ(outcome.status, 128 + signal) << outcome.err;
        const std::string command =
            "; to go on: incise run scene.toml --end-time 0.15 --set 'material[0].young=1.5e3' "
            "--resume\n";
        EXPECT_TRUE(outcome.err.ends_with(command)) << outcome.err;

        // Without what it began with it is another run.
        outcome = run({"scene.toml", "--quiet", "--resume"});
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.err.find("dynamics.end_time was 0.15 and is 0.05, material[0].young was "
                                   "1500 and is 5000; resume with"),
                  std::string::npos)
            << outcome.err;

        auto resuming = arguments;
        resuming.push_back("--resume");
        outcome = run(resuming);
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        expect_same(files_of(folder_ / "scene.out"), files_of(folder_ / "whole"));
    }
}

TEST_F(ResumedProcess, EndsAsIfItHadNeverBeenKilled) {
    const auto files = whole(cut_scene);
    Random random(11);
    std::size_t num_kills = 0;
    // How many kills come in time is chance: more rounds until there are enough.
    constexpr std::size_t enough = 7;
    for (int round = 0; round < 6 || (num_kills < enough && round < 60); ++round) {
        SCOPED_TRACE(round);
        fs::remove_all(folder_ / "scene.out");
        // Again and again.
        for (int i = 0; i < 3; ++i) {
            std::vector<std::string> arguments{"scene.toml", "--quiet"};
            if (has_checkpoint()) arguments.push_back("--resume");
            const pid_t child = start(arguments);
            if (i == 0) wait_for_frame(random.below(4));
            std::this_thread::sleep_for(std::chrono::microseconds(random.below(20000)));
            ::kill(child, SIGKILL);
            finish(child);
            num_kills += signal_ == SIGKILL;
        }
        expect_to_end_as(files);
    }
    EXPECT_GE(num_kills, enough);
}

TEST_F(ResumedProcess, SurvivesAKillAtEachChangeOfFiles) {
    const auto files = whole(cut_scene);
    const std::size_t count = num_calls("kill");
    ASSERT_GT(count, 50u);
    for (std::size_t at = 1; at <= count; at += 3) {
        SCOPED_TRACE(at);
        fs::remove_all(folder_ / "scene.out");
        run({"scene.toml", "--quiet"}, with_fault("kill", at));
        ASSERT_EQ(signal_, SIGKILL);
        if (fs::exists(folder_ / "scene.out")) expect_readable(folder_ / "scene.out");
        expect_to_end_as(files);
    }
}

TEST_F(ResumedProcess, ReportsEachFailedCallAndGoesOn) {
    const auto files = whole(cut_scene);
    for (const std::string& fault : {std::to_string(EIO), std::string("half")}) {
        SCOPED_TRACE(fault);
        const std::size_t count = num_calls(fault);
        ASSERT_GT(count, 50u);
        for (std::size_t at = fault == "half" ? 1 : 5; at <= count; at += 8) {
            SCOPED_TRACE(at);
            fs::remove_all(folder_ / "scene.out");
            const auto outcome = run({"scene.toml", "--quiet"}, with_fault(fault, at));
            EXPECT_EQ(outcome.status, 4) << outcome.err;
            EXPECT_EQ(outcome.err.find("incise: scene.out"), 0u) << outcome.err;
            EXPECT_NE(outcome.err.find(": cannot be written: "), std::string::npos);
            EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
            EXPECT_EQ(outcome.err.ends_with("to go on then: incise run scene.toml --resume\n"),
                      has_checkpoint())
                << outcome.err;
            if (fs::exists(folder_ / "scene.out")) expect_readable(folder_ / "scene.out");
            expect_to_end_as(files);
        }
    }
}

TEST_F(ResumedProcess, ReportsEachFailedOpeningAndGoesOn) {
    const auto files = whole(cut_scene);
    ASSERT_EQ(run({"scene.toml", "--quiet", "--out", "counted"},
                  with_fault_of_opening(EMFILE, 0, (folder_ / "count").string()))
                  .status,
              0);
    const std::size_t count = std::stoul(read_text(folder_ / "count"));
    ASSERT_GT(count, 20u);
    for (std::size_t at = 1; at <= count; at += 2) {
        SCOPED_TRACE(at);
        const auto [fault, remedy] = at % 4 == 1
                                         ? std::pair(EMFILE, "raise the limit on open files")
                                         : std::pair(EACCES, "choose a folder that you may write");
        fs::remove_all(folder_ / "scene.out");
        const auto outcome = run({"scene.toml", "--quiet"}, with_fault_of_opening(fault, at));
        EXPECT_EQ(outcome.status, 4) << outcome.err;
        EXPECT_EQ(outcome.err.find("incise: scene.out"), 0u) << outcome.err;
        EXPECT_NE(outcome.err.find(": cannot be written: "), std::string::npos) << outcome.err;
        EXPECT_NE(outcome.err.find(remedy), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
        expect_readable(folder_ / "scene.out");
        expect_to_end_as(files);
    }
}

TEST_F(ResumedProcess, TakesAnEarlierCheckpointWithAWarning) {
    const auto files = whole(cut_scene);
    run({"scene.toml", "--quiet"}, with_fault("kill", num_calls("kill") - 8));
    ASSERT_EQ(signal_, SIGKILL);
    std::vector<fs::path> checkpoints;
    for (const auto& entry : fs::directory_iterator(folder_ / "scene.out/checkpoints"))
        if (entry.path().extension() == ".checkpoint") checkpoints.push_back(entry.path());
    std::sort(checkpoints.begin(), checkpoints.end());
    ASSERT_EQ(checkpoints.size(), 2u);
    fs::resize_file(checkpoints[1], fs::file_size(checkpoints[1]) - 1);
    auto outcome = run({"scene.toml", "--quiet", "--resume"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err.find("incise: warning: scene.out/checkpoints/"), 0u) << outcome.err;
    EXPECT_NE(outcome.err.find("is damaged: its checksum is wrong; trying the checkpoint before"),
              std::string::npos);
    expect_same(files_of(folder_ / "scene.out"), files);

    // Finished: there is nothing more to do but what a kill at the very end has left undone.
    write("scene.out/checkpoints/stop_000000000001.checkpoint", "");
    outcome = run({"scene.toml", "--resume"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "scene.out/scene.pvd\n");
    EXPECT_NE(outcome.err.find("is finished; there is nothing to resume"), std::string::npos);
    expect_same(files_of(folder_ / "scene.out"), files);
}

TEST_F(ResumedProcess, ReportsMissedExpectationsOfAFinishedRunAgain) {
    write("scene.toml", scene + "[expect]\ntime = { max = 0.01 }\n");
    const auto first = run({"scene.toml", "--quiet"});
    EXPECT_EQ(first.status, 1);
    const auto again = run({"scene.toml", "--quiet", "--resume"});
    EXPECT_EQ(again.status, 1);
    EXPECT_EQ(again.err, first.err);
}

TEST_F(ResumedProcess, RefusesASummaryThatNoRunHasWritten) {
    write("scene.toml", scene);
    ASSERT_EQ(run({"scene.toml", "--quiet"}).status, 0);
    write("scene.out/summary.json", "{\"status\": 7}");
    const auto outcome = run({"scene.toml", "--resume"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err,
              "incise: scene.out/summary.json: 'status' is '7', and should be a text; remove the "
              "file to go on from the last checkpoint, or begin anew without --resume\n");
}

TEST_F(ResumedProcess, RefusesFoldersInThePlaceOfItsFiles) {
    write("scene.toml", scene);
    const auto refusal = [&](const std::string& path, const std::string& of) {
        fs::create_directories(folder_ / path);
        const auto outcome = run({"scene.toml", "--resume"});
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.err, "incise: " + path + ": is a directory in the place of " + of +
                                   "; remove it, and resume then\n");
    };
    refusal("scene.out/checkpoints/step_000000000003.checkpoint", "a checkpoint");
    refusal("scene.out/summary.json", "the summary of a run");
}

TEST_F(ResumedProcess, BeginsWhereThereIsNothingToResume) {
    write("scene.toml", scene);
    auto outcome = run({"scene.toml", "--resume"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_TRUE(outcome.err.starts_with("scene: begins, as there is nothing to resume in "))
        << outcome.err;
    const auto files = files_of(folder_ / "scene.out");
    fs::remove_all(folder_ / "scene.out");
    fs::create_directories(folder_ / "scene.out/checkpoints");
    outcome = run({"scene.toml", "--resume", "--quiet"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    expect_same(files_of(folder_ / "scene.out"), files);
}

// Also one whose end is between two frames.
TEST_F(ResumedProcess, MakesAFinishedRunLonger) {
    write("scene.toml", endless + "checkpoint_interval = 0.02\n");
    ASSERT_EQ(run({"scene.toml", "--quiet", "--end-time", "0.2", "--out", "whole"}).status, 0);
    const auto whole = files_of(folder_ / "whole");
    for (const char* first_end : {"0.1", "0.0987"}) {
        SCOPED_TRACE(first_end);
        fs::remove_all(folder_ / "scene.out");
        ASSERT_EQ(run({"scene.toml", "--quiet", "--end-time", first_end}).status, 0);
        auto outcome = run({"scene.toml", "--quiet", "--end-time", "0.2", "--resume"});
        EXPECT_EQ(outcome.status, 0) << outcome.err;
        expect_same(files_of(folder_ / "scene.out"), whole);
        outcome = run({"scene.toml", "--quiet", "--end-time", "0.15", "--resume"});
        EXPECT_EQ(outcome.status, 2);
        EXPECT_NE(outcome.err.find("dynamics.end_time was 0.2 and is 0.15"), std::string::npos)
            << outcome.err;
    }
}

TEST_F(ResumedProcess, LeavesTheFolderOfAnotherRunAlone) {
    write("scene.toml", endless);
    const pid_t child = start({"scene.toml", "--quiet", "--end-time", "90"});
    wait_for_frame(2);
    for (const char* how : {"--quiet", "--resume"}) {
        // Its streams are those of the first one, which says nothing.
        const auto second = finish(start({"scene.toml", "--end-time", "90", how}));
        EXPECT_EQ(second.status, 2);
        EXPECT_NE(second.err.find("incise: scene.out: another run is writing there; "),
                  std::string::npos)
            << second.err;
    }
    ::kill(child, SIGTERM);
    EXPECT_EQ(finish(child).status, 143);
    EXPECT_EQ(summary().at("status"), "interrupted");
    expect_readable(folder_ / "scene.out");
}

TEST_F(ResumedProcess, NeedsNoThreadButItsOwn) {
    write("scene.toml", scene + "[output]\ninterval = 0.01\n");
    const Environment environment{{"LD_PRELOAD", INCISE_FAULTS}, {"INCISE_FAULT_THREADS", "1"}};
    std::vector<std::string> arguments{"scene.toml", "--quiet", "--end-time",
                                       "0.05",       "--set",   "mesh.box.cells=[10, 10, 10]",
                                       "--threads",  "2"};
    auto outcome = run(arguments, environment);
    EXPECT_EQ(outcome.status, 5);
    EXPECT_EQ(outcome.err.find("incise: out of memory or of processes: "), 0u) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    arguments.back() = "1";
    outcome = run(arguments, environment);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const auto files = files_of(folder_ / "scene.out");
    ASSERT_EQ(run(arguments).status, 0);
    expect_same(files_of(folder_ / "scene.out"), files);
}

// Wherever memory ends: also within VTK, whose compressors and streams do not expect it.
TEST_F(ResumedProcess, EndsWithOneMessageWhereMemoryEnds) {
    write("scene.toml", scene + "[output]\ninterval = 0.01\n");
    int num_refused = 0, status = 5;
    for (long at = 1; status == 5; at += 1 + at / 20, ++num_refused) {
        const auto outcome =
            run({"scene.toml", "--quiet", "--set", "mesh.box.cells=[6, 6, 6]"},
                {{"LD_PRELOAD", INCISE_FAULTS}, {"INCISE_FAULT_MEMORY", std::to_string(at)}});
        status = outcome.status;
        ASSERT_EQ(signal_, 0) << at << outcome.err;
        ASSERT_TRUE(status == 5 || status == 0) << at << outcome.err;
        EXPECT_EQ(
            outcome.err,
            status == 0 ? "" : "incise: out of memory: the mesh is too large for this machine\n")
            << at;
    }
    EXPECT_GT(num_refused, 20);
}

}  // namespace
}  // namespace incise::test
