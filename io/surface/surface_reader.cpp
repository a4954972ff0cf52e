// Reading of surfaces from files. A new format needs a file and a row of `surface_formats`.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/surface_reader.h"

#include <algorithm>
#include <string_view>

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/scanner.h"
#include "incise/io/surface/obj_reader.h"
#include "incise/io/surface/off_reader.h"
#include "incise/io/surface/ply_reader.h"
#include "incise/io/surface/stl_reader.h"

namespace incise::io {

namespace {

struct SurfaceFormat {
    const char* name;
    const char* suffix;
    std::string_view magic;  ///< beginning of its text, in lower case; empty: suffix only
    SurfaceFile (*read)(const InputFile& file);
};

constexpr SurfaceFormat surface_formats[] = {
    {"STL", ".stl", "solid", read_stl},
    {"PLY", ".ply", "ply", read_ply},
    {"OFF", ".off", "off", read_off},
    {"OBJ", ".obj", "", read_obj},
};
constexpr const SurfaceFormat* stl = &surface_formats[0];

constexpr std::size_t longest_surface_magic = 8;

const SurfaceFormat* surface_format_of(const InputFile& file) {
    // First, because the title of a binary STL may begin like any other format.
    if (is_binary_stl(file)) return stl;
    const auto begin = std::find_if_not(file.bytes.begin(), file.bytes.end(), is_blank);
    const auto head =
        lower_case(std::string_view(begin, file.bytes.end()).substr(0, longest_surface_magic));
    for (const auto& format : surface_formats)
        if (!format.magic.empty() && head.starts_with(format.magic)) return &format;
    const auto suffix = lower_case(file.path.extension().string());
    for (const auto& format : surface_formats)
        if (suffix == format.suffix) return &format;
    return nullptr;
}

}  // namespace

bool has_surface_suffix(const std::filesystem::path& path) {
    const auto suffix = lower_case(path.extension().string());
    return std::ranges::any_of(
        surface_formats, [&](const SurfaceFormat& format) { return suffix == format.suffix; });
}

SurfaceFile read_surface(const std::filesystem::path& path) {
    const auto file = load_input_file(path);
    const auto* format = surface_format_of(file);
    if (format == nullptr) {
        std::string known;
        for (const auto& row : surface_formats)
            known += std::string(known.empty() ? "" : ", ") + row.name + " (" + row.suffix + ")";
        throw InputError(file.name() +
                         ": neither begins nor is named like a surface format known here; convert "
                         "it to one of: " +
                         known);
    }
    return format->read(file);
}

}  // namespace incise::io
