// A scenario file of a test, beside a mesh file to refer to.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/scenario/body.h"
#include "incise/scenario/scenario_reader.h"
#include "support/temporary_folder.h"

namespace incise::scenario {

/// What the shortest useful scenario needs besides a mesh.
inline const std::string minimal_rest = R"([[material]]
density = 1060
young = 1600
poisson = 0.45
[dynamics]
end_time = 1
)";
inline const std::string minimal_mesh = R"([mesh]
box = { size = [1, 1, 1], cells = [2, 2, 2] }
)";
inline const std::string minimal = minimal_mesh + minimal_rest;

class ScenarioFile {
  public:
    explicit ScenarioFile(const std::string& text, const std::string& name = "scene.toml")
        : path_(folder_ / name) {
        std::ofstream(path_) << text;
        std::ofstream(folder_ / "liver.vtu") << "not looked into";
    }
    const std::filesystem::path& path() const { return path_; }

    ScenarioReport read(const std::vector<std::string>& overrides = {}) const {
        return read_scenario(path_, overrides);
    }

    /// The messages without the folder in front.
    std::vector<std::string> errors(const std::vector<std::string>& overrides = {}) const {
        return without_folder(read(overrides).errors);
    }
    /// With what only the body shows.
    std::vector<std::string> all_errors() const {
        ScenarioReport report = read();
        const auto of_body = check_body(report.scenario).errors;
        report.errors.insert(report.errors.end(), of_body.begin(), of_body.end());
        return without_folder(report.errors);
    }
    std::vector<std::string> warnings(const std::vector<std::string>& overrides = {}) const {
        return without_folder(read(overrides).warnings);
    }

  private:
    std::vector<std::string> without_folder(std::vector<std::string> messages) const {
        const std::string folder = path_.parent_path().string() + "/";
        for (auto& message : messages)
            for (auto at = message.find(folder); at != message.npos; at = message.find(folder))
                message.erase(at, folder.size());
        return messages;
    }

    support::TemporaryFolder folder_;
    std::filesystem::path path_;
};

/// The errors of the minimal scenario with `text` added, in one line: `text` begins on line 9.
inline std::string error_of(const std::string& text) {
    const auto errors = ScenarioFile(minimal + text).errors();
    std::string all;
    for (const auto& error : errors) all += (all.empty() ? "" : " | ") + error;
    return all;
}

}  // namespace incise::scenario
