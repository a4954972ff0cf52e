// The command line of incise-render.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "incise/app/render/section.h"
#include "incise/base/types.h"

namespace incise::render {

/// The options of incise-render.
struct Options {
    std::filesystem::path input;
    std::filesystem::path out;        ///< if empty, DIR/pictures, or beside a .vtu file
    std::vector<std::size_t> frames;  ///< if empty, the last frame
    bool is_all = false;
    std::optional<std::string> color;
    std::optional<std::pair<double, double>> range;
    std::array<int, 2> size = {1280, 960};  ///< pixels
    Vec3 view = {-0.55, -1.0, 0.55};        ///< from the body to the eye
    std::optional<Section> section;
    std::filesystem::path film;  ///< of all frames; if empty, none
    bool has_edges = false;      ///< if true, the lines of the mesh are drawn
};

/// Returns the options. Returns an exit status after --help and --version, and after an error,
/// which is printed on stderr.
std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace incise::render
