// Folders as runs leave them, written by hand: small, and with whatever a test needs in them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace incise::test {

using Json = nlohmann::ordered_json;

inline const std::string history_head =
    "time,step,nodes,elements,components,mass,volume,kinetic_energy,elastic_energy,external_work,"
    "dissipated_energy,momentum_x,momentum_y,momentum_z,contacts,reaction_clamp_x,"
    "reaction_clamp_y,reaction_clamp_z,force_probe_x,force_probe_y,force_probe_z\n";

/// A row of a body that falls; `components` jumps at the cut.
inline std::string history_row(int step, int components = 1) {
    const double t = 0.01 * step;
    std::string row = std::to_string(t) + "," + std::to_string(step);
    row += ",8," + std::to_string(5 + components) + "," + std::to_string(components);
    row += ",0.5,0.001," + std::to_string(t * t) + "," + std::to_string(0.5 * t) + "," +
           std::to_string(2.0 * t) + "," + std::to_string(0.1 * t);
    return row + ",0,0," + std::to_string(-t) + ",0,0,0," + std::to_string(t) + ",0,0,0.25\n";
}

inline Json edit_at(int step, const std::string& tool) {
    const Json body = {{"mass", 0.5},
                       {"volume", 0.001},
                       {"kinetic_energy", 0.25},
                       {"elastic_energy", 0.5},
                       {"momentum", {0.0, 0.0, -0.1}},
                       {"angular_momentum", {0.0, 0.0, 0.0}}};
    Json after = body;
    after["elastic_energy"] = 0.125;
    return {{"time", 0.01 * step}, {"step", step},        {"tool", tool},   {"elements_crossed", 4},
            {"cut_area", 0.25},    {"mass_removed", 0.0}, {"before", body}, {"after", after}};
}

inline Json summary_of(const std::string& status, const std::string& title) {
    return {{"status", status},
            {"title", title},
            {"scenario", "fall"},
            {"version", "0.2.0"},
            {"threads", 2},
            {"step", 20},
            {"wall_time", 2.0},
            {"frames", 0},
            {"command", "incise run fall.toml"},
            {"directory", "/tmp"},
            {"started", "2026-11-28T01:10:00Z"},
            {"warnings", Json::array()}};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
}

/// JSON of any bytes: those that are not UTF-8 are replaced, as runs do.
inline std::string json_text(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// A run of 20 rows with two edits, by tools of these names.
inline void write_fall(const std::filesystem::path& folder, const std::string& title = "A fall",
                       const std::string& tool = "blade") {
    std::string history = history_head;
    for (int step = 0; step <= 20; ++step) history += history_row(step, step < 10 ? 1 : 2);
    write_text(folder / "history.csv", history);
    write_text(folder / "edits.jsonl",
               json_text(edit_at(10, tool)) + "\n" + json_text(edit_at(12, tool + "_2")) + "\n");
    write_text(folder / "summary.json", json_text(summary_of("finished", title)));
    write_text(folder / "fall.toml", "# " + title + "\n[mesh]\n");
}

}  // namespace incise::test
