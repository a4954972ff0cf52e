// A triangulated surface as plain arrays, as the readers of surfaces return it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// Triangles over points, numbered from 0 in the order of the source. The surface need not be
/// closed, oriented or free of intersections: code that needs such a property checks it.
struct SurfaceData {
    std::vector<Vec3> points;  ///< in the unit of the source
    /// Point numbers, in the orientation of the source.
    std::vector<std::array<std::int64_t, 3>> triangles;
    static void archive(auto& ar, auto& self) { ar(self.points, self.triangles); }
};

}  // namespace incise::topology
