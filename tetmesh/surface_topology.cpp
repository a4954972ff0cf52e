// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/surface_topology.h"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <vector>

#include "incise/base/disjoint_set.h"

namespace incise::tetmesh {

SurfaceTopology topology_of(std::span<const std::array<std::int64_t, 3>> triangles) {
    struct Side {
        std::int64_t low, high;
        std::int32_t low_corner, high_corner;  // 3 times the triangle, plus the local corner
    };
    std::vector<Side> sides;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t next = (k + 1) % 3;
            auto a = std::pair(triangles[t][k], static_cast<std::int32_t>(3 * t + k)),
                 b = std::pair(triangles[t][next], static_cast<std::int32_t>(3 * t + next));
            if (b < a) std::swap(a, b);
            sides.push_back({a.first, b.first, a.second, b.second});
        }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::tuple(s.low, s.high); });
    DisjointSet fans(3 * triangles.size()), parts(triangles.size());
    for (std::size_t i = 1; i < sides.size(); ++i) {
        const Side &a = sides[i - 1], &b = sides[i];
        if (a.low != b.low || a.high != b.high) continue;
        fans.join(a.low_corner, b.low_corner);
        fans.join(a.high_corner, b.high_corner);
        parts.join(a.low_corner / 3, b.low_corner / 3);
    }
    SurfaceTopology found;
    const auto n = static_cast<std::int32_t>(triangles.size());
    for (std::int32_t t = 0; t < n; ++t) found.num_parts += parts.find(t) == t ? 1 : 0;
    for (std::int32_t c = 0; c < 3 * n; ++c) found.euler += fans.find(c) == c ? 1 : 0;
    found.euler -= n / 2;  // edges are three halves of the triangles
    return found;
}

}  // namespace incise::tetmesh
