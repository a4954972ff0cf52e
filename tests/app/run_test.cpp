// incise run as users and scripts meet it: exit statuses, messages, and files that survive
// whatever ends it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <thread>
#include <vector>

#include "io/mesh_reader.h"
#include "support/mesh_families.h"
#include "support/temporary_folder.h"

namespace incise {
namespace {

using nlohmann::json;
using support::read_text;
using testing::Message;
namespace fs = std::filesystem;

const std::string scene = R"([mesh]
box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }
[[material]]
density = 1000
young = 1000
poisson = 0.4
[[constraint]]
name = "floor"
where = { half_space = { point = [0, 0, 0], normal = [0, 0, -1] } }
fix = "xyz"
[[tool]]
kind = "carver"
shape = { sphere = { radius = 0.03 } }
path = [{ time = 0.01, at = [0.05, 0.05, 0.1] }, { time = 0.04, at = [0.05, 0.05, 0.06] }]
[dynamics]
end_time = 0.05
gravity = [0, 0, -9.81]
)";

/// Too long to end by itself within a test, with a frame at every step or so.
const std::string endless = scene + "[output]\ninterval = 0.001\ncompression = \"none\"\n";

struct Outcome {
    int status = -1;
    std::string out, err;
};

class Run : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
    }

    /// Starts `incise run` in the folder.
    pid_t start(std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {INCISE_PROGRAM, "run"});
        std::vector<char*> argv;
        for (auto& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        const pid_t child = ::fork();
        if (child != 0) return child;
        const auto redirect = [&](const char* name, int to) {
            const int file = ::open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
            return file >= 0 && ::dup2(file, to) == to;
        };
        if (::chdir(folder_.path().c_str()) == 0 && redirect("stdout", STDOUT_FILENO) &&
            redirect("stderr", STDERR_FILENO))
            ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    /// Waits for its end. A status of 128 + n: ended by signal n, not by itself.
    Outcome finish(pid_t child) {
        int result = 0;
        if (::waitpid(child, &result, 0) != child) return {};
        signal_ = WIFSIGNALED(result) ? WTERMSIG(result) : 0;
        return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }
    Outcome run(const std::vector<std::string>& arguments) { return finish(start(arguments)); }

    /// Until the frame is there, of this run or of one before it in the same folder.
    void wait_for_frame(std::size_t number) {
        const auto path =
            folder_ / ("scene.out/frames/scene_00000" + std::to_string(number) + ".vtu");
        for (int i = 0; i < 5000 && !fs::exists(path); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }

    json summary() { return json::parse(read_text(folder_ / "scene.out/summary.json")); }

    /// Everything that is there can be read and fits together; the number of frames in the index.
    std::size_t expect_readable(const fs::path& out) {
        const auto lines = [&](const char* name) {
            std::vector<std::string> all;
            if (!fs::exists(out / name)) return all;
            const std::string text = read_text(out / name);
            EXPECT_TRUE(text.empty() || text.back() == '\n') << name;
            std::istringstream stream(text);
            for (std::string line; std::getline(stream, line);) all.push_back(line);
            return all;
        };
        const auto history = lines("history.csv");
        for (const auto& line : history)
            EXPECT_EQ(std::count(line.begin(), line.end(), ','),
                      std::count(history[0].begin(), history[0].end(), ','));
        for (const auto& line : lines("edits.jsonl"))
            EXPECT_TRUE(json::parse(line, nullptr, false).is_object()) << line;
        if (fs::exists(out / "summary.json")) {
            EXPECT_TRUE(json::parse(read_text(out / "summary.json"), nullptr, false).is_object());
        }
        if (fs::exists(out / "scene.vtu.series")) {
            const auto series = json::parse(read_text(out / "scene.vtu.series"), nullptr, false);
            EXPECT_TRUE(series.is_object());
            for (const auto& file : series["files"])
                EXPECT_TRUE(fs::exists(out / file.at("name").get<std::string>()));
        }
        if (!fs::exists(out / "scene.pvd")) return 0;
        const std::string pvd = read_text(out / "scene.pvd");
        EXPECT_NE(pvd.find("</VTKFile>"), std::string::npos);
        const std::regex file("file=\"([^\"]*)\"");
        std::size_t count = 0;
        for (std::sregex_iterator i(pvd.begin(), pvd.end(), file), end; i != end; ++i, ++count)
            EXPECT_NO_THROW(io::read_mesh(out / (*i)[1].str()));
        EXPECT_LE(count, history.size());  // a row follows each frame
        return count;
    }

    support::TemporaryFolder folder_;
    int signal_ = 0;
};

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

TEST_F(Run, TakesValuesFromTheCommandLine) {
    write("scene.toml", scene);
    EXPECT_EQ(run({"scene.toml", "--end-time", "0.02"}).status, 0);
    EXPECT_EQ(summary().at("time"), 0.02);
    const auto hash = summary().at("scenario_hash");
    EXPECT_EQ(
        run({"scene.toml", "--set", "dynamics.end_time=0.03", "--set", "material[0].density=2000"})
            .status,
        0);
    EXPECT_EQ(summary().at("time"), 0.03);
    EXPECT_NEAR(summary().at("mass").get<double>() + summary().at("mass_removed").get<double>(),
                2.0, 1e-12);
    EXPECT_NE(summary().at("scenario_hash"), hash);
}

TEST_F(Run, TellsMissedExpectationsAndWritesAllTheSame) {
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

TEST_F(Run, RefusesAFixedStepAboveTheBound) {
    write("scene.toml", scene + "time_step = 0.04\n");
    const auto outcome = run({"scene.toml"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_NE(outcome.err.find("dynamics.time_step of 0.04 s is above the stable step of 0.0"),
              std::string::npos);
    EXPECT_FALSE(fs::exists(folder_ / "scene.out"));
}

TEST_F(Run, StopsWithTheLastGoodFrameWhenTheMotionBlowsUp) {
    write("scene.toml", scene + R"([[constraint]]
where = { half_space = { point = [0, 0, 0.1], normal = [0, 0, 1] } }
move = [{ time = 0.033, by = [0, 0, 0] }, { time = 0.034, by = [0, 0, 500] }]
)");
    const auto outcome = run({"scene.toml", "--quiet"});
    EXPECT_EQ(outcome.status, 3);
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(std::regex_search(
        outcome.err, std::regex("^incise: scene: step [0-9]+, t = 0\\.03[0-9]* s: element [0-9]+, "
                                "node [0-9]+ .*support is moved too fast.*scene\\.pvd\n$")))
        << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 4u);  // 0 to 0.03
    EXPECT_EQ(summary().at("status"), "failed");
    EXPECT_NE(summary().at("message").get<std::string>().find("moved too fast"), std::string::npos);
    EXPECT_EQ(summary().at("frames"), 4);
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
    test::Random random(4);
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
    EXPECT_EQ(run({"scene.toml", "--quiet"}).status, 0);
    EXPECT_EQ(expect_readable(folder_ / "scene.out"), 51u);
    EXPECT_EQ(support::count_entries(folder_ / "scene.out/frames"), 51u);
}

}  // namespace
}  // namespace incise
