// SPDX-License-Identifier: LGPL-3.0-or-later
#include "io/series.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "io/atomic_file.h"
#include "io/number_format.h"
#include "io/number_text.h"
#include "io/vtu_writer.h"
#include "topology/error.h"

namespace incise::io {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view frame_suffix = ".vtu";

std::string escape_xml(std::string_view text) {
    std::string out;
    for (const char c : text) switch (c) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    return out;
}

std::string escape_json(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '"' || c == '\\') out += '\\';
        out += c;
    }
    return out;
}

/// Control characters have no place in XML, and a slash none in a name.
void check_name(const std::string& name) {
    const bool is_fit = !name.empty() && std::none_of(name.begin(), name.end(), [](char c) {
        return c == '/' || static_cast<unsigned char>(c) < ' ' || c == '\x7f';
    });
    if (!is_fit)
        throw InputError("'" + name +
                         "' cannot name the files of a run: give a name without "
                         "slashes and control characters");
}

}  // namespace

Series::Series(fs::path folder, std::string name, Compression compression,
               std::span<const double> kept_times)
    : folder_(std::move(folder)),
      name_(std::move(name)),
      compression_(compression),
      times_(kept_times.begin(), kept_times.end()) {
    check_name(name_);
    make_output_folder(folder_);
    make_output_folder(folder_ / "frames");
    remove_unfinished_files(folder_ / "frames");
    for (std::size_t i = 0; i < times_.size(); ++i) {
        std::error_code error;
        if (!fs::is_regular_file(frame_path(i), error))
            throw InputError(frame_path(i).string() +
                             ": this frame of the run to be resumed is missing; begin anew");
    }
    // First out of the indexes, then off the disk: a kill in between leaves valid indexes.
    if (times_.empty()) {
        remove_output_file(pvd_path());
        remove_output_file(folder_ / (name_ + ".vtu.series"));
    } else {
        write_indexes();
    }
    remove_frames_from(times_.size());
}

void Series::add(const Frame& frame) {
    const double time = frame.time.value_or(0.0);
    if (!std::isfinite(time) || (!times_.empty() && !(time > times_.back())))
        throw std::invalid_argument("the time of a frame must be finite and above the last one's");
    write_vtu(frame_path(times_.size()), frame, compression_);
    times_.push_back(time);
    write_indexes();
}

fs::path Series::pvd_path() const { return folder_ / (name_ + ".pvd"); }

fs::path Series::frame_path(std::size_t index) const { return folder_ / frame_name(index); }

std::string Series::frame_name(std::size_t index) const {
    constexpr std::size_t num_digits = 6;  // at least
    auto digits = std::to_string(index);
    digits.insert(0, num_digits - std::min(num_digits, digits.size()), '0');
    return "frames/" + name_ + "_" + digits + std::string(frame_suffix);
}

/// Removes the frames of this name (NAME_, digits, suffix) that are numbered `first` and above.
void Series::remove_frames_from(std::size_t first) {
    const auto frames = folder_ / "frames";
    const auto prefix = name_ + "_";
    std::vector<fs::path> stale;
    std::error_code error;
    for (fs::directory_iterator entry(frames, error), end; !error && entry != end;
         entry.increment(error)) {
        const auto file_name = entry->path().filename().string();
        std::string_view text = file_name;
        if (!text.starts_with(prefix) || !text.ends_with(frame_suffix)) continue;
        text.remove_prefix(prefix.size());
        text.remove_suffix(std::min(text.size(), frame_suffix.size()));
        const bool is_number =
            std::all_of(text.begin(), text.end(), [](char c) { return '0' <= c && c <= '9'; });
        const auto number = parse_number<std::size_t>(text);
        if (is_number && number && *number >= first) stale.push_back(entry->path());
    }
    if (error) throw_output_error(frames, error.value());
    for (const auto& path : stale) remove_output_file(path);
}

void Series::write_indexes() {
    std::string pvd =
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n";
    std::string series = "{\n  \"file-series-version\": \"1.0\",\n  \"files\": [";
    for (std::size_t i = 0; i < times_.size(); ++i) {
        const auto time = format_number(times_[i]);
        const auto file = frame_name(i);
        pvd += "    <DataSet timestep=\"" + time + "\" part=\"0\" file=\"" + escape_xml(file) +
               "\"/>\n";
        series += (i == 0 ? "\n" : ",\n");
        series += "    {\"name\": \"" + escape_json(file) + "\", \"time\": " + time + "}";
    }
    pvd += "  </Collection>\n</VTKFile>\n";
    series += "\n  ]\n}\n";
    write_file(pvd_path(), pvd);
    write_file(folder_ / (name_ + ".vtu.series"), series);
}

}  // namespace incise::io
