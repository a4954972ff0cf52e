// incise run as a process of its own in a folder of its own: started, stopped, killed; and what it
// leaves.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "incise/io/mesh/mesh_reader.h"
#include "support/temporary_folder.h"

namespace incise::test {

using nlohmann::json;
using support::read_text;
namespace fs = std::filesystem;

inline const std::string scene = R"([mesh]
box = { size = [0.1, 0.1, 0.1], cells = [2, 2, 2] }
[[material]]
density = 1000
young = 5000
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
inline const std::string endless = scene + "[output]\ninterval = 0.001\ncompression = \"none\"\n";

struct Outcome {
    int status = -1;
    std::string out, err;
};

class Run : public testing::Test {
  protected:
    void write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name) << text;
    }

    using Environment = std::vector<std::pair<std::string, std::string>>;

    /// Starts `incise` in the folder, with variables of the environment besides.
    pid_t start_incise(std::vector<std::string> arguments, const Environment& environment = {}) {
        arguments.insert(arguments.begin(), INCISE_PROGRAM);
        std::vector<char*> argv;
        for (auto& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        const pid_t child = ::fork();
        if (child != 0) return child;
        const auto redirect = [&](const char* name, int to) {
            const int file = ::open((folder_ / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
            return file >= 0 && ::dup2(file, to) == to;
        };
        for (const auto& [name, value] : environment) ::setenv(name.c_str(), value.c_str(), 1);
        if (::chdir(folder_.path().c_str()) == 0 && redirect("stdout", STDOUT_FILENO) &&
            redirect("stderr", STDERR_FILENO))
            ::execv(argv[0], argv.data());
        ::_exit(127);
    }
    /// `incise run`.
    pid_t start(std::vector<std::string> arguments, const Environment& environment = {}) {
        arguments.insert(arguments.begin(), "run");
        return start_incise(std::move(arguments), environment);
    }
    /// Waits for its end. A status of 128 + n: ended by signal n, not by itself.
    Outcome finish(pid_t child) {
        int result = 0;
        if (::waitpid(child, &result, 0) != child) return {};
        signal_ = WIFSIGNALED(result) ? WTERMSIG(result) : 0;
        return {WIFEXITED(result) ? WEXITSTATUS(result) : -1, read_text(folder_ / "stdout"),
                read_text(folder_ / "stderr")};
    }
    Outcome run(const std::vector<std::string>& arguments, const Environment& environment = {}) {
        return finish(start(arguments, environment));
    }
    Outcome incise(const std::vector<std::string>& arguments, const Environment& environment = {}) {
        return finish(start_incise(arguments, environment));
    }

    /// Until the frame is there, of this run or of one before it in the same folder.
    void wait_for_frame(std::size_t number) {
        const auto path =
            folder_ / ("scene.out/frames/scene_00000" + std::to_string(number) + ".vtu");
        for (int i = 0; i < 5000 && !fs::exists(path); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }

    /// Until the process has a handler for the signal, or has ended.
    static void wait_until_caught(pid_t child, int signal) {
        const auto is_caught = [&] {
            std::ifstream status("/proc/" + std::to_string(child) + "/status");
            const std::string key = "SigCgt:";
            for (std::string line; std::getline(status, line);)
                if (line.starts_with(key))
                    return ((std::stoull(line.substr(key.size()), nullptr, 16) >> (signal - 1)) &
                            1u) != 0;
            return true;
        };
        while (!is_caught()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
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
        const std::string_view before = "file=\"";
        std::size_t count = 0;
        for (auto i = pvd.find(before); i != pvd.npos; i = pvd.find(before, i), ++count) {
            i += before.size();
            EXPECT_NO_THROW(io::read_mesh(out / pvd.substr(i, pvd.find('"', i) - i)));
        }
        EXPECT_LE(count, history.size());  // a row follows each frame
        return count;
    }

    support::TemporaryFolder folder_;
    int signal_ = 0;
};

}  // namespace incise::test
