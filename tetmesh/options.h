// The command line of incise-tetmesh.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <variant>
#include <vector>

#include "tetmesh/tetrahedral_mesher.h"

namespace incise::tetmesh {

struct Options {
    std::vector<std::filesystem::path> in;  ///< several surfaces, or one image
    std::filesystem::path out;
    ElementSizes sizes;           ///< in the unit of `out`
    std::optional<double> angle;  ///< at which an edge is kept, rad
    double scale = 1.0;           ///< of the coordinates of `in`
    bool has_labels = false;      ///< the image has labels, also if it looks like a scan
};

/// Returns the options, or the exit status if there is nothing more to do: after --help, or after
/// a message about wrong options.
std::variant<Options, int> parse_options(int argc, const char* const* argv);

}  // namespace incise::tetmesh
