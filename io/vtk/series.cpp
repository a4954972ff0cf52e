// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/series.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/io/files/atomic_file.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"
#include "incise/io/vtk/vtu_writer.h"

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

/// Removes the first character from a text and returns it. Returns nothing if it is not UTF-8.
std::optional<char32_t> next_character(std::string_view& text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const std::size_t size = byte(0) < 0x80   ? 1
                             : byte(0) < 0xC2 ? 0
                             : byte(0) < 0xE0 ? 2
                             : byte(0) < 0xF0 ? 3
                             : byte(0) < 0xF5 ? 4
                                              : 0;
    if (size == 0 || size > text.size()) return std::nullopt;
    char32_t character = size == 1 ? byte(0) : byte(0) & (0xFFu >> (size + 1));
    for (std::size_t i = 1; i < size; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return std::nullopt;
        character = character << 6 | (byte(i) & 0x3Fu);
    }
    constexpr std::array<char32_t, 5> least{0, 0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = 0xD800 <= character && character < 0xE000;
    if (character < least[size] || is_surrogate || character > 0x10FFFF) return std::nullopt;
    text.remove_prefix(size);
    return character;
}

/// Returns the path of a frame, relative to the folder of the run.
std::string frame_name(const std::string& series, std::size_t index) {
    constexpr std::size_t num_digits = 6;  // at least
    auto digits = std::to_string(index);
    digits.insert(0, num_digits - std::min(num_digits, digits.size()), '0');
    return "frames/" + series + "_" + digits + std::string(frame_suffix);
}

}  // namespace

// XML cannot contain text that is not UTF-8, most control characters, U+FFFE and U+FFFF. A file
// name cannot contain a slash.
void require_series_name(std::string_view name) {
    bool is_fit = !name.empty();
    for (std::string_view rest = name; is_fit && !rest.empty();) {
        const auto c = next_character(rest);
        is_fit = c && *c >= ' ' && *c != '/' && *c != 0x7F && *c != 0xFFFE && *c != 0xFFFF;
    }
    if (!is_fit)
        throw InputError(in_quotes(name) +
                         " cannot name the files of a run: rename it, in UTF-8 and without "
                         "slashes and control characters");
}

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
    require_series_name(name_);
    make_output_folder(folder_);
    make_output_folder(folder_ / "frames");
    remove_unfinished_files(folder_ / "frames");
    // Frames are removed from the indexes before they are removed from the disk. A kill in between
    // then leaves valid indexes.
    if (frames_.empty()) {
        remove_output_file(pvd_path());
        remove_output_file(series_path());
    } else {
        write_indexes(OnDisk::now);
    }
    remove_frames_from(frames_.size());
}

void Series::add(const Frame& frame) {
    const double time = frame.time.value_or(0.0);
    if (!std::isfinite(time) || (!frames_.empty() && !(time > frames_.back().time)))
        throw std::invalid_argument("the time of a frame must be finite and above the last one's");
    const std::string text = vtu_text(frame, compression_, &packed_);
    const fs::path path = folder_ / frame_name(name_, frames_.size());
    write_file(path, text, OnDisk::later);
    not_on_disk_.push_back(path);
    frames_.push_back({time, {}});
    frames_.back().file.append(text);
    write_indexes(OnDisk::later);
    if (std::chrono::steady_clock::now() - last_sync_ > std::chrono::seconds(1)) sync();
}

// The frames first: indexes on the disk name only frames that are there.
void Series::sync() {
    last_sync_ = std::chrono::steady_clock::now();
    if (not_on_disk_.empty()) return;
    sync_files(not_on_disk_);
    not_on_disk_.clear();
    sync_files(std::array{pvd_path(), series_path()});
}

fs::path Series::pvd_path() const { return folder_ / (name_ + ".pvd"); }
fs::path Series::series_path() const { return folder_ / (name_ + ".vtu.series"); }

/// Removes the frames of this name (NAME_, digits, suffix) with the number `first` or a higher one.
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

void Series::write_indexes(OnDisk on_disk) {
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
    write_file(pvd_path(), pvd, on_disk);
    write_file(series_path(), series, on_disk);
}

}  // namespace incise::io
