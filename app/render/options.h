// What the user asked incise-render to do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "incise/base/types.h"

namespace incise::render {

struct Options {
    std::filesystem::path input;
    std::filesystem::path out;         ///< empty: beside the input
    std::optional<std::size_t> frame;  ///< none: the last
    bool is_all = false;
    std::optional<std::string> color;
    std::optional<std::pair<double, double>> range;
    std::array<int, 2> size = {1280, 960};
    Vec3 view = {-0.55, -1.0, 0.55};
    bool has_edges = false;
};

/// The options, or the exit status where there is nothing to do: after --help, --version, or a
/// fault, which this has told on stderr.
std::variant<Options, int> parse_options(int argc, char** argv);

}  // namespace incise::render
