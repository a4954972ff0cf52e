// A triangulated surface as plain arrays: what the readers of surfaces deliver.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// Triangles over points, numbered from 0 in the order of the source. The type promises nothing
/// about the contents (closed, oriented, free of intersections): whoever needs it checks it.
struct SurfaceData {
    std::vector<Vec3> points;                            ///< in the unit of the source
    std::vector<std::array<std::int64_t, 3>> triangles;  ///< point numbers, in the source's sense
    static void archive(auto& ar, auto& self) { ar(self.points, self.triangles); }
};

}  // namespace incise::topology
