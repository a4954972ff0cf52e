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

/// In the folder of the run.
std::string frame_name(const std::string& series, std::size_t index) {
    constexpr std::size_t num_digits = 6;  // at least
    auto digits = std::to_string(index);
    digits.insert(0, num_digits - std::min(num_digits, digits.size()), '0');
    return "frames/" + series + "_" + digits + std::string(frame_suffix);
}

}  // namespace

void require_frames(const fs::path& folder, const std::string& name,
                    std::span<const FrameWritten> frames) {
    for (std::size_t i = 0; i < frames.size(); ++i)
        require_is(folder / frame_name(name, i), frames[i].file);
}

Series::Series(fs::path folder, std::string name, Compression compression,
               std::span<const FrameWritten> kept)
    : folder_(std::move(folder)),
      name_(std::move(name)),
      compression_(compression),
      frames_(kept.begin(), kept.end()) {
    check_name(name_);
    make_output_folder(folder_);
    make_output_folder(folder_ / "frames");
    remove_unfinished_files(folder_ / "frames");
    // First out of the indexes, then off the disk: a kill in between leaves valid indexes.
    if (frames_.empty()) {
        remove_output_file(pvd_path());
        remove_output_file(folder_ / (name_ + ".vtu.series"));
    } else {
        write_indexes();
    }
    remove_frames_from(frames_.size());
}

void Series::add(const Frame& frame) {
    const double time = frame.time.value_or(0.0);
    if (!std::isfinite(time) || (!frames_.empty() && !(time > frames_.back().time)))
        throw std::invalid_argument("the time of a frame must be finite and above the last one's");
    const std::string text = vtu_text(frame, compression_);
    write_file(folder_ / frame_name(name_, frames_.size()), text);
    frames_.push_back({time, {}});
    frames_.back().file.append(text);
    write_indexes();
}

fs::path Series::pvd_path() const { return folder_ / (name_ + ".pvd"); }

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
    for (std::size_t i = 0; i < frames_.size(); ++i) {
        const auto time = format_number(frames_[i].time);
        const auto file = frame_name(name_, i);
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
