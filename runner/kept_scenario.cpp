// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/kept_scenario.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "incise/io/files/atomic_file.h"

namespace incise::runner {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view first_line =
    "# What `incise run` has run: its scenario, with --set and --end-time.\n";

fs::path path_in(const fs::path& folder, const scenario::Scenario& scenario) {
    return folder / (scenario.name + ".toml");
}

/// Returns the bytes of a file; none if it cannot be read.
std::string bytes_of(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

bool has_summary_of(const fs::path& folder, const scenario::Scenario& scenario) {
    const auto summary = nlohmann::json::parse(bytes_of(folder / "summary.json"), nullptr, false);
    return summary.is_object() && summary.contains("scenario_hash") &&
           summary["scenario_hash"] == scenario.hash;
}

}  // namespace

void keep_scenario(const fs::path& folder, const scenario::Scenario& scenario) {
    const fs::path path = path_in(folder, scenario);
    std::error_code none;
    if (fs::equivalent(path, scenario.folder / (scenario.name + ".toml"), none)) return;
    io::write_file(path, std::string(first_line) + scenario.text);
}

bool is_kept_scenario(std::string_view text) { return text.starts_with(first_line); }

bool holds_another_run(const fs::path& folder, const scenario::Scenario& scenario) {
    std::error_code none;
    const fs::path history = folder / "history.csv";
    if (!fs::is_regular_file(history, none) || fs::file_size(history, none) == 0) return false;
    return !bytes_of(path_in(folder, scenario)).ends_with("\n" + scenario.text) &&
           !has_summary_of(folder, scenario);
}

}  // namespace incise::runner
