// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/app/report/run_record.h"

#include <sys/stat.h>

#include <algorithm>
#include <string_view>
#include <system_error>

#include "incise/app/dates.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/input_file.h"

namespace incise::report {

namespace fs = std::filesystem;

namespace {

constexpr const char* file_remedy = "; restore the file, or run the scenario again";

/// Parses JSON. Throws InputError that begins with `place`.
Json parse_json(std::string_view text, const std::string& place) {
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw InputError(place + ": is no JSON from its byte " + std::to_string(error.byte) +
                         " on" + file_remedy);
    }
}

void read(const Json& object, const char* key, double& value) {
    const auto it = object.find(key);
    if (it != object.end() && it->is_number()) value = it->get<double>();
}

void read(const Json& object, const char* key, Vec3& value) {
    const auto it = object.find(key);
    if (it == object.end() || !it->is_array() || it->size() != 3) return;
    for (int i = 0; i < 3; ++i)
        if (const Json& x = (*it)[static_cast<std::size_t>(i)]; x.is_number())
            value[i] = x.get<double>();
}

BodyState body_state(const Json& edit, const char* key) {
    BodyState state;
    const auto it = edit.find(key);
    if (it == edit.end() || !it->is_object()) return state;
    read(*it, "mass", state.mass);
    read(*it, "volume", state.volume);
    read(*it, "kinetic_energy", state.kinetic_energy);
    read(*it, "elastic_energy", state.elastic_energy);
    read(*it, "momentum", state.momentum);
    read(*it, "angular_momentum", state.angular_momentum);
    return state;
}

Edit edit_of(const Json& line, const std::string& place) {
    const auto lacks = [&](const char* key) {
        throw InputError(place + ": has no '" + key + "', as each edit has" + file_remedy);
    };
    if (!line.is_object()) throw InputError(place + ": is not a JSON object" + file_remedy);
    Edit edit;
    if (!line.contains("time") || !line["time"].is_number()) lacks("time");
    if (!line.contains("step") || !line["step"].is_number()) lacks("step");
    if (!line.contains("tool") || !line["tool"].is_string()) lacks("tool");
    edit.time = line["time"].get<double>();
    edit.step = line["step"].get<double>();
    edit.tool = line["tool"].get<std::string>();
    read(line, "elements_crossed", edit.elements_crossed);
    read(line, "elements_split", edit.elements_split);
    read(line, "elements_added", edit.elements_added);
    read(line, "elements_removed", edit.elements_removed);
    read(line, "faces_opened", edit.faces_opened);
    read(line, "nodes_added", edit.nodes_added);
    read(line, "cut_area", edit.cut_area);
    read(line, "mass_removed", edit.mass_removed);
    read(line, "volume_joined", edit.volume_joined);
    read(line, "volume_released", edit.volume_released);
    edit.before = body_state(line, "before");
    edit.after = body_state(line, "after");
    return edit;
}

std::vector<Edit> read_edits(const fs::path& path) {
    std::error_code none;
    if (!fs::exists(path, none))
        throw InputError(path.string() + ": is missing, and each run writes it" + file_remedy);
    std::vector<Edit> edits;
    if (fs::is_regular_file(path, none) && fs::file_size(path, none) == 0) return edits;
    const io::InputFile file = io::load_input_file(path);
    std::size_t line_number = 0;
    for (std::string_view rest = file.bytes; !rest.empty();) {
        const auto end = rest.find('\n');
        const auto line = rest.substr(0, end);
        rest.remove_prefix(end == rest.npos ? rest.size() : end + 1);
        const std::string place = file.name() + ":" + std::to_string(++line_number);
        edits.push_back(edit_of(parse_json(line, place), place));
    }
    return edits;
}

Json read_summary(const fs::path& path) {
    std::error_code none;
    if (!fs::exists(path, none)) return Json::object();
    const io::InputFile file = io::load_input_file(path);
    Json summary = parse_json(file.bytes, file.name());
    if (!summary.is_object() || !summary.contains("status") || !summary["status"].is_string())
        throw InputError(file.name() +
                         ": is not the summary of a run, which is a JSON object with 'status'" +
                         file_remedy);
    return summary;
}

/// Returns the name of the scenario: as the summary has it, or that of the index of the frames, or
/// of the only scenario in the folder.
std::string name_of(const fs::path& folder, const Json& summary) {
    if (const auto it = summary.find("scenario"); it != summary.end() && it->is_string())
        return it->get<std::string>();
    for (const char* suffix : {".pvd", ".toml"}) {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder))
            if (entry.path().extension() == suffix) names.push_back(entry.path().stem().string());
        if (names.size() == 1) return names.front();
    }
    return fs::weakly_canonical(folder).filename().string();
}

std::vector<double> read_frame_times(const fs::path& path) {
    std::vector<double> times;
    std::error_code none;
    if (!fs::exists(path, none)) return times;
    const io::InputFile file = io::load_input_file(path);
    const Json series = parse_json(file.bytes, file.name());
    const auto files = series.find("files");
    if (files == series.end() || !files->is_array())
        throw InputError(file.name() + ": has no list 'files'" + file_remedy);
    for (const Json& frame : *files) {
        double time = unknown;
        if (frame.is_object()) read(frame, "time", time);
        times.push_back(time);
    }
    return times;
}

/// Returns the text of the file; nothing if it cannot be read.
std::optional<std::string> text_of_file(const fs::path& path) {
    std::error_code none;
    if (!fs::is_regular_file(path, none) || fs::file_size(path, none) == 0) return std::nullopt;
    return io::load_input_file(path).bytes;
}

std::string time_of_writing(const fs::path& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 ? app::utc_text(status.st_mtime) : std::string();
}

fs::path folder_of_run(const fs::path& given) {
    std::error_code none;
    if (given.extension() == ".pvd" && fs::is_regular_file(given, none))
        return given.has_parent_path() ? given.parent_path() : fs::path(".");
    if (!fs::exists(given, none))
        throw InputError(given.string() +
                         ": no such folder; give the folder that incise run made, such as "
                         "liver.out");
    if (!fs::is_directory(given, none)) {
        const auto results = given.stem().string() + ".out";
        throw InputError(given.string() + ": is a file; give the folder that incise run made" +
                         (given.extension() == ".toml" ? ", by default " + results : ""));
    }
    if (!fs::exists(given / "history.csv", none))
        throw InputError(given.string() +
                         ": is not the folder of a run, as it has no history.csv; give the folder "
                         "that incise run made, such as liver.out");
    return given;
}

}  // namespace

std::string RunRecord::text(const char* entry) const {
    const auto it = summary.find(entry);
    return it != summary.end() && it->is_string() ? it->get<std::string>() : std::string();
}

double RunRecord::number(const char* entry) const {
    double value = unknown;
    read(summary, entry, value);
    return value;
}

std::string RunRecord::title() const {
    const auto title = text("title");
    return title.empty() ? name : title;
}

RunRecord read_run(const fs::path& given) {
    RunRecord run;
    run.folder = folder_of_run(given);
    run.summary = read_summary(run.folder / "summary.json");
    run.name = name_of(run.folder, run.summary);
    // Before the edits: a run that goes on writes an edit before its row.
    run.history = read_history(run.folder / "history.csv");
    run.edits = read_edits(run.folder / "edits.jsonl");
    if (const auto* steps = run.history.find("step"); steps && !steps->empty())
        std::erase_if(run.edits,
                      [last = steps->back()](const Edit& edit) { return edit.step > last; });
    run.frame_times = read_frame_times(run.folder / (run.name + ".vtu.series"));
    run.scenario_text = text_of_file(run.folder / (run.name + ".toml"));
    run.written =
        time_of_writing(run.folder / (run.has_summary() ? "summary.json" : "history.csv"));
    return run;
}

}  // namespace incise::report
