// Pictures of a run, for its report.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace incise::report {

struct Picture {
    std::size_t frame = 0;
    std::string png;  ///< the bytes of the file
};

struct Pictures {
    std::vector<Picture> items;
    std::string note;  ///< why there are none; may be empty
};

}  // namespace incise::report
