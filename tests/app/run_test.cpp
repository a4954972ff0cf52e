// incise run as users and scripts meet it: exit statuses, messages, and files that survive
// whatever ends it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sys/resource.h>

#include "run_process.h"
#include "support/mesh_families.h"

namespace incise::test {
namespace {

TEST_F(Run, ToItsEndTellsWhereTheResultIs) {
    write("scene.toml", scene);
    const auto outcome = run({"scene.toml"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "scene.out/scene.pvd\n");
    EXPECT_NE(outcome.err.find("scene: 48 elements, 27 nodes, 1 piece"), std::string::npos);
    EXPECT_NE(outcome.err.find("6 frames"), std::string::npos);
    EXPECT_EQ(summary().at("status"), "finished");
    EXPECT_EQ(summary().at("time"), 0.05);
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 6u);

    const auto quiet = run({"scene.toml", "--quiet", "--out", "else where"});
    EXPECT_EQ(quiet.status, 0);
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(quiet.out, "else where/scene.pvd\n");
    EXPECT_EQ(read_text(folder_ / "else where/frames/scene_000005.vtu"),
              read_text(folder_ / "scene.out/frames/scene_000005.vtu"));
}

TEST_F(Run, DryRunWritesNothing) {
    write("scene.toml", scene);
    const auto outcome = run({"scene.toml", "--dry-run", "--out", "out"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("48 elements"), std::string::npos);
    EXPECT_EQ(support::count_entries(folder_.path()), 3u);  // the scenario and the two streams
    // But it finds what a run would stumble over.
    EXPECT_EQ(run({"scene.toml", "--dry-run", "--set", "dynamics.time_step=1"}).status, 3);
    EXPECT_EQ(support::count_entries(folder_.path()), 3u);
}

TEST_F(Run, StoppedBeforeItsFirstStepLeavesNothing) {
    // Far from its first step for a second or more.
    write("scene.toml", scene + "[output]\ninterval = 0.01\n");
    const std::vector<std::string> arguments{"scene.toml", "--quiet", "--set",
                                             "mesh.box.cells=[40, 40, 40]"};
    for (const int signal : {SIGINT, SIGTERM}) {
        const pid_t child = start(arguments);
        wait_until_caught(child, signal);
        ::kill(child, signal);
        const auto outcome = finish(child);
        EXPECT_EQ(outcome.status, 128 + signal);
        EXPECT_EQ(outcome.err,
                  "incise: scene.toml: stopped before its first step; nothing has been written\n");
        EXPECT_EQ(support::count_entries(folder_.path()), 3u);  // the scenario and the two streams
    }
}

TEST_F(Run, StoppedWhileReadingCheckpointsTellsHowToResume) {
    write("scene.toml", scene);
    // Of holes, to be read one after another.
    const fs::path checkpoints = folder_ / "scene.out/checkpoints";
    fs::create_directories(checkpoints);
    for (int i = 100; i < 200; ++i) {
        const auto path = checkpoints / ("step_000000000" + std::to_string(i) + ".checkpoint");
        std::ofstream(path).flush();
        fs::resize_file(path, 100'000'000);
    }
    const pid_t child = start({"scene.toml", "--resume", "--threads", "2"});
    wait_until_caught(child, SIGINT);
    ::kill(child, SIGINT);
    const auto outcome = finish(child);
    EXPECT_EQ(outcome.status, 130);
    EXPECT_EQ(outcome.err,
              "incise: scene.toml: stopped before it went on; nothing has been changed; to go on: "
              "incise run scene.toml "
              "--threads 2 --resume\n");
    EXPECT_EQ(support::count_entries(checkpoints), 100u);
}

TEST_F(Run, TakesValuesFromTheCommandLine) {
    write("scene.toml", scene);
    EXPECT_EQ(run({"scene.toml", "--end-time", "0.02"}).status, 0);
    EXPECT_EQ(summary().at("time"), 0.02);
    const auto hash = summary().at("scenario_hash");
    EXPECT_EQ(run({"scene.toml", "--set", "dynamics.end_time=0.03", "--set",
                   "material[0].density=2000", "--force"})
                  .status,
              0);
    EXPECT_EQ(summary().at("time"), 0.03);
    EXPECT_NEAR(summary().at("mass").get<double>() + summary().at("mass_removed").get<double>(),
                2.0, 1e-12);
    EXPECT_NE(summary().at("scenario_hash"), hash);
}

TEST_F(Run, LeavesTheResultsOfAnotherRun) {
    write("scene.toml", scene);
    ASSERT_EQ(run({"scene.toml", "--quiet"}).status, 0);
    const auto hash = summary().at("scenario_hash");
    const std::vector<std::string> other{"scene.toml", "--quiet", "--set", "material[0].young=900"};
    const auto outcome = run(other);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.err,
              "incise: scene.out: holds the results of another run; give this one another folder "
              "with --out, or replace the results with --force; if only end_time is later, go on "
              "with --resume\n");
    EXPECT_EQ(summary().at("scenario_hash"), hash);
    EXPECT_EQ(run({"scene.toml", "--quiet"}).status, 0);  // the same again
    auto forced = other;
    forced.push_back("--force");
    EXPECT_EQ(run(forced).status, 0);
    EXPECT_NE(summary().at("scenario_hash"), hash);
}

TEST_F(Run, KeepsTheScenarioThatItHasRun) {
    fs::create_directories(folder_ / "given");
    write("given/scene.toml", scene);
    ASSERT_EQ(run({"given/scene.toml", "--quiet", "--out", "first"}).status, 0);
    fs::copy_file(folder_ / "first/frames/scene_000000.vtu", folder_ / "given/mesh.vtu");
    write("given/scene.toml",
          "# Lost.\ntitle = \"a \\\"title\\\"\"\n[mesh]\nfile = \"mesh.vtu\"\n" +
              scene.substr(scene.find("[[material]]")));
    ASSERT_EQ(run({"given/scene.toml", "--quiet", "--out", "second", "--set",
                   "material[0].young=1.5e3", "--end-time", "0.03"})
                  .status,
              0);
    ASSERT_EQ(run({"second/scene.toml", "--quiet", "--out", "third"}).status, 0);
    for (const char* file : {"history.csv", "edits.jsonl", "frames/scene_000002.vtu"})
        EXPECT_EQ(support::read_text(folder_ / "third" / file),
                  support::read_text(folder_ / "second" / file))
            << file;
    // Beside the results, the scenario stays as its author wrote it.
    const std::string text = support::read_text(folder_ / "given/scene.toml");
    EXPECT_EQ(run({"given/scene.toml", "--quiet", "--out", "given"}).status, 0);
    EXPECT_EQ(support::read_text(folder_ / "given/scene.toml"), text);
}

TEST_F(Run, ReportsMissedExpectationsAndWritesAllTheSame) {
    write("scene.toml", scene +
                            "[expect]\ntime = { max = 0.01 }\nmass = { min = 5, max = 6 }\n"
                            "mass_error = { max = 1e-12 }\n");
    const auto outcome = run({"scene.toml", "--quiet"});
    EXPECT_EQ(outcome.status, 1);
    EXPECT_EQ(outcome.err.find("incise: scene: expected time of at most 0.01, it is 0.05\n"
                               "incise: scene: expected mass of at least 5, it is 0."),
              0u)
        << outcome.err;
    EXPECT_EQ(outcome.err.find("mass_error"), std::string::npos);
    EXPECT_EQ(summary().at("status"), "finished");
}

TEST_F(Run, RefusesBadInputBeforeItWritesAnything) {
    const auto refused = [&](const std::string& text, const std::vector<std::string>& more = {}) {
        write("scene.toml", text);
        std::vector<std::string> arguments{"scene.toml"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const auto outcome = run(arguments);
        EXPECT_EQ(outcome.status, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err.find("incise: "), 0u) << outcome.err;
        EXPECT_FALSE(fs::exists(folder_ / "scene.out"));
        return outcome.err;
    };
    EXPECT_NE(refused(scene + "dampin = 1\n").find("scene.toml:18:1: "), std::string::npos);
    EXPECT_NE(refused(scene + "[expect]\nmas = { min = 1 }\n").find("mass_error"),
              std::string::npos);
    EXPECT_NE(refused(scene, {"--end-time", "-1"}).find("-1"), std::string::npos);

    const auto with_mesh = [](const std::string& file) {
        return "[mesh]\nfile = \"" + file + "\"\n" + scene.substr(scene.find("[[material]]"));
    };
    write("broken.vtu", "no mesh at all");
    EXPECT_NE(refused(with_mesh("broken.vtu")).find("broken.vtu"), std::string::npos);
    EXPECT_NE(refused(with_mesh("missing.vtu")).find("missing.vtu"), std::string::npos);

    std::string elsewhere = scene;
    elsewhere.replace(elsewhere.find("[0, 0, -1] }"), 12,
                      "[1, 0, 0] }, sphere = { center = "
                      "[9, 9, 9], radius = 1 }");
    EXPECT_NE(refused(elsewhere).find("constraint 'floor' selects no node"), std::string::npos);
}

TEST_F(Run, RefusesAMeshThatItWouldReplace) {
    write("scene.toml", scene);
    ASSERT_EQ(run({"scene.toml", "--quiet"}).status, 0);
    write("scene.toml", "[mesh]\nfile = \"scene.out/frames/scene_000001.vtu\"\n" +
                            scene.substr(scene.find("[[material]]")));
    const auto outcome = run({"scene.toml", "--quiet", "--force"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("scene_000001.vtu: lies among the frames in scene.out"),
              std::string::npos)
        << outcome.err;
    EXPECT_EQ(run({"scene.toml", "--quiet", "--out", "other"}).status, 0);
}

// The files of a run do not come to be what the program prints on.
TEST_F(Run, KeepsToItsFilesWithoutStandardStreams) {
    write("scene.toml", scene);
    ASSERT_EQ(run({"scene.toml", "--quiet"}).status, 0);
    const std::string command = "cd '" + folder_.path().string() +
                                "' && '" INCISE_PROGRAM
                                "' run scene.toml --out mute <&- 2>&- >/dev/null";
    EXPECT_EQ(std::system(command.c_str()), 0);
    for (const char* file : {"history.csv", "edits.jsonl"})
        EXPECT_EQ(read_text(folder_ / "mute" / file), read_text(folder_ / "scene.out" / file));
}

TEST_F(Run, RefusesAFixedStepAboveTheBound) {
    write("scene.toml", scene + "time_step = 0.04\n");
    const auto outcome = run({"scene.toml"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.err.find("incise: scene.toml:18:13: dynamics.time_step of 0.04 s is above "
                               "the stable step of 0.0"),
              0u)
        << outcome.err;
    const auto overridden = run({"scene.toml", "--set", "dynamics.time_step=5"});
    EXPECT_EQ(overridden.status, 3);
    EXPECT_EQ(overridden.err.find("incise: --set dynamics.time_step=5: dynamics.time_step of 5 s "
                                  "is above the stable step of 0.0"),
              0u)
        << overridden.err;
    EXPECT_FALSE(fs::exists(folder_ / "scene.out"));
}

TEST_F(Run, KeepsTheLastGoodFrameOfUnstableMotion) {
    write("scene.toml", scene + R"([[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0.033, by = [0, 0, 0] }, { time = 0.034, by = [0, 0, 500] }]
)");
    const auto outcome = run({"scene.toml", "--quiet"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.out, "");
    const testing::Matcher<const std::string&> has_its_form = testing::MatchesRegex(
        "incise: scene: step [0-9]+, t = 0\\.03[0-9]* s: element [0-9]+, "
        "node [0-9]+ .*constraint moves too fast.*scene\\.pvd\n");
    EXPECT_TRUE(has_its_form.Matches(outcome.err)) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 4u);  // 0 to 0.03
    EXPECT_EQ(summary().at("status"), "failed");
    EXPECT_NE(summary().at("message").get<std::string>().find("moves too fast"), std::string::npos);
    EXPECT_EQ(summary().at("frames"), 4);
}

// So does one that a tool stops: both end with an error about the input.
TEST_F(Run, ThatARefusedOrderStopsLeavesASummary) {
    write("scene.toml", scene);
    write("hands.jsonl", R"({"incise_recording":1,"scenario":"scene","hash":"1","set":[],)"
                         R"("body":"1","version":"0","tick_length":0.01}
{"tick":0}
{"tick":1}
{"tick":2,"orders":[{"move":"knife","at":[0,0,0],"rotation":[0,0,0,1]}]}
{"tick":3}
)");
    const auto outcome = run({"scene.toml", "--quiet", "--out", "scene.out", "--replay",
                              "hands.jsonl", "--set", "dynamics.end_time=0.05"});
    EXPECT_EQ(outcome.status, 2);
    const testing::Matcher<const std::string&> has_its_form = testing::MatchesRegex(
        "incise: scene: step [0-9]+, t = 0\\.02 s: tick 2 of the recording: there is no tool "
        "'knife' .*scene\\.pvd\n");
    EXPECT_TRUE(has_its_form.Matches(outcome.err)) << outcome.err;
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 3u);  // 0 to 0.02
    EXPECT_EQ(summary().at("status"), "failed");
    EXPECT_NE(summary().at("message").get<std::string>().find("there is no tool 'knife'"),
              std::string::npos);
    EXPECT_EQ(summary().at("time"), 0.02);
}

TEST_F(Run, FailsWhereItCannotWrite) {
    write("scene.toml", scene);
    write("file", "not a folder");
    for (const char* out : {"file/out", "file", "/dev/null/out", "/proc/none/out"}) {
        const auto outcome = run({"scene.toml", "--quiet", "--out", out});
        EXPECT_EQ(outcome.status, 4) << out;
        EXPECT_EQ(outcome.err.find(std::string("incise: ") + out), 0u) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    }
    EXPECT_EQ(read_text(folder_ / "file"), "not a folder");
    // A folder stands where a frame is to go.
    fs::create_directories(folder_ / "blocked/frames/scene_000002.vtu/x");
    const auto outcome = run({"scene.toml", "--quiet", "--out", "blocked"});
    EXPECT_EQ(outcome.status, 4) << outcome.err;
    EXPECT_NE(outcome.err.find("scene_000002.vtu"), std::string::npos);
}

TEST_F(Run, FailsWhenTheDiskIsFull) {
    if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here";
    write("scene.toml", scene);
    for (const char* name : {"history.csv", "edits.jsonl"}) {
        fs::remove_all(folder_ / "out");
        fs::create_directories(folder_ / "out");
        fs::create_symlink("/dev/full", folder_ / "out" / name);
        const auto outcome = run({"scene.toml", "--quiet", "--out", "out"});
        EXPECT_EQ(outcome.status, 4) << name;
        EXPECT_EQ(outcome.err.find(std::string("incise: out/") + name), 0u) << outcome.err;
        EXPECT_NE(outcome.err.find("no space left"), std::string::npos) << outcome.err;
    }
}

TEST_F(Run, StopsOnSignalsWithEverythingWritten) {
    write("scene.toml", endless);
    for (const int signal : {SIGINT, SIGTERM}) {
        fs::remove_all(folder_ / "scene.out");
        const pid_t child = start({"scene.toml", "--quiet", "--end-time", "90"});
        wait_for_frame(3);
        ::kill(child, signal);
        const auto outcome = finish(child);
        EXPECT_EQ(outcome.status, 128 + signal);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err.find("incise: stopped at t = "), 0u) << outcome.err;
        const std::size_t num_frames = expect_readable(folder_ / "scene.out");
        EXPECT_GE(num_frames, 3u);
        EXPECT_EQ(summary().at("status"), "interrupted");
        EXPECT_EQ(summary().at("frames"), num_frames);
        EXPECT_GT(summary().at("time"), 0.0);
    }
}

TEST_F(Run, LeavesWholeFilesWhenKilledAtAnyMoment) {
    write("scene.toml", endless);
    Random random(4);
    std::size_t most_frames = 0;
    for (int round = 0; round < 20; ++round) {
        SCOPED_TRACE(round);
        // Every other run begins with the ruins of the one before.
        if (round % 2 == 0) fs::remove_all(folder_ / "scene.out");
        const pid_t child = start({"scene.toml", "--quiet", "--end-time", "90"});
        if (round % 4 != 0) wait_for_frame(random.below(8));
        std::this_thread::sleep_for(std::chrono::microseconds(random.below(30000)));
        ::kill(child, SIGKILL);
        finish(child);
        EXPECT_EQ(signal_, SIGKILL);
        if (!fs::exists(folder_ / "scene.out")) continue;  // it had not come so far
        most_frames = std::max(most_frames, expect_readable(folder_ / "scene.out"));
        EXPECT_FALSE(fs::exists(folder_ / "scene.out/summary.json"));
    }
    EXPECT_GT(most_frames, 2u);
    // And the next one that is let to its end finds nothing in its way.
    EXPECT_EQ(run({"scene.toml", "--quiet", "--force"}).status, 0);
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 51u);
    EXPECT_EQ(support::count_entries(folder_ / "scene.out/frames"), 51u);
}

TEST_F(Run, EndsWithASentenceWhereMemoryEnds) {
    std::string large = scene;
    large.replace(large.find("[2, 2, 2]"), 9, "[40, 40, 40]");
    write("scene.toml", large);
    constexpr rlim_t megabyte = rlim_t{1} << 20;
    for (const rlim_t megabytes : {rlim_t{100}, rlim_t{150}, rlim_t{200}}) {
        rlimit before{};
        ::getrlimit(RLIMIT_AS, &before);
        const rlimit limit{megabytes * megabyte, before.rlim_max};
        ::setrlimit(RLIMIT_AS, &limit);  // the child inherits it
        const pid_t child = start({"scene.toml", "--quiet"});
        ::setrlimit(RLIMIT_AS, &before);
        const auto outcome = finish(child);
        EXPECT_EQ(outcome.status, 5) << megabytes;
        EXPECT_EQ(outcome.err, "incise: out of memory: the mesh is too large for this machine\n");
    }
    // What no machine has is refused at once.
    large.replace(large.find("[40, 40, 40]"), 12, "[10000, 10000, 10000]");
    write("scene.toml", large);
    const auto outcome = run({"scene.toml"});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("makes 6e+12 elements, more than the 1e+08 allowed"),
              std::string::npos);
}

TEST_F(Run, TakesAllThreadsAskedForWithoutWarning) {
    write("scene.toml", scene);
    const auto outcome = run({"scene.toml", "--quiet", "--end-time", "0.05", "--set",
                              "mesh.box.cells=[10, 10, 10]", "--threads", "40"});
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
}

}  // namespace
}  // namespace incise::test
