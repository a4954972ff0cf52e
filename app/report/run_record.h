// What a run has left in its folder, as far as a report needs it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "incise/app/report/history_table.h"
#include "incise/base/types.h"

namespace incise::report {

using Json = nlohmann::ordered_json;

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The body before or after an edit. A value that the file does not have is NaN.
struct BodyState {
    double mass = unknown, volume = unknown;                    // kg, m3
    double kinetic_energy = unknown, elastic_energy = unknown;  // J
    Vec3 momentum = Vec3::Constant(unknown);                    // kg m/s
    Vec3 angular_momentum = Vec3::Constant(unknown);            // kg m2/s

    double energy() const { return kinetic_energy + elastic_energy; }
};

/// A line of edits.jsonl. A value that the line does not have is NaN.
struct Edit {
    double time = 0.0;  // s
    double step = 0.0;
    std::string tool;
    double elements_crossed = unknown, elements_split = unknown, elements_added = unknown,
           elements_removed = unknown, faces_opened = unknown, nodes_added = unknown;
    double cut_area = unknown, mass_removed = unknown;          // m2, kg
    double volume_joined = unknown, volume_released = unknown;  // m3
    BodyState before, after;
};

/// A run.
struct RunRecord {
    std::filesystem::path folder;
    std::string name;  ///< of the scenario; of the folder if nothing tells the scenario
    /// summary.json. An empty object if there is none: the run goes on, or was killed.
    Json summary = Json::object();
    HistoryTable history;
    std::vector<Edit> edits;
    std::vector<double> frame_times;           ///< s
    std::optional<std::string> scenario_text;  ///< NAME.toml, if it is there
    std::string written;                       ///< when the newest file was written, UTC

    /// Returns an entry of the summary as text. Returns an empty text if it has none.
    std::string text(const char* entry) const;
    /// Returns an entry of the summary, or NaN if it has none. JSON has null for such a number.
    double number(const char* entry) const;
    std::string title() const;
    bool has_summary() const { return !summary.empty(); }
};

/// Reads the folder of a run, or the folder of a .pvd file.
/// Throws InputError with file, line and remedy if it is not the folder of a run, or if one of its
/// files is missing or damaged.
RunRecord read_run(const std::filesystem::path& folder);

}  // namespace incise::report
