// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

namespace incise::cutting {

namespace {

using topology::SurfaceData;
using Corners = std::array<std::int64_t, 3>;  // numbers of points

const Vec3& point(const SurfaceData& surface, std::int64_t p) {
    return surface.points[static_cast<std::size_t>(p)];
}

/// Returns "what at [x, y, z]" for the middle of an edge.
std::string at_edge(const SurfaceData& surface, const std::string& what, std::int64_t a,
                    std::int64_t b) {
    const Vec3 middle = 0.5 * (point(surface, a) + point(surface, b));
    std::ostringstream text;
    text << what << " at [" << middle.x() << ", " << middle.y() << ", " << middle.z() << "]";
    return text.str();
}

}  // namespace

double volume_of(const SurfaceData& surface) {
    if (surface.points.empty()) return 0.0;
    const Vec3& o = surface.points[0];
    double sum = 0.0;
    for (const auto& [a, b, c] : surface.triangles)
        sum += (point(surface, a) - o).dot((point(surface, b) - o).cross(point(surface, c) - o));
    return sum / 6.0;
}

Solid make_solid(const SurfaceData& surface, bool& was_turned) {
    Solid solid;
    std::map<std::array<double, 3>, std::int64_t> known;
    const auto number_of = [&](std::int64_t p) {
        const Vec3 x = point(surface, p);
        // Adding 0 turns -0 into 0.
        const auto [it, is_new] =
            known.try_emplace({x.x() + 0.0, x.y() + 0.0, x.z() + 0.0},
                              static_cast<std::int64_t>(solid.surface.points.size()));
        if (is_new) solid.surface.points.push_back(x);
        return it->second;
    };
    for (const Corners& t : surface.triangles) {
        const Vec3 &a = point(surface, t[0]), &b = point(surface, t[1]), &c = point(surface, t[2]);
        if ((b - a).cross(c - a).isZero(0.0)) continue;
        solid.surface.triangles.push_back({number_of(t[0]), number_of(t[1]), number_of(t[2])});
    }
    was_turned = volume_of(solid.surface) < 0.0;
    if (was_turned)
        for (Corners& t : solid.surface.triangles) std::swap(t[1], t[2]);
    return solid;
}

std::string fault_of(const Solid& solid) {
    const SurfaceData& surface = solid.surface;
    if (surface.triangles.empty()) return "its surface has no triangle";
    if (!std::ranges::all_of(surface.points, [](const Vec3& x) { return x.allFinite(); }))
        return "a point of its surface is not finite";
    // How often triangles run along an edge from its lower to its higher point, and back.
    std::map<std::pair<std::int64_t, std::int64_t>, std::array<int, 2>> edges;
    for (const Corners& t : surface.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::int64_t a = t[k], b = t[(k + 1) % 3];
            if (a < 0 || a >= static_cast<std::int64_t>(surface.points.size()))
                return "a triangle of its surface names point " + std::to_string(a) +
                       ", and there are " + std::to_string(surface.points.size());
            ++edges[std::minmax(a, b)][a < b ? 0 : 1];
        }
    for (const auto& [edge, counts] : edges) {
        const auto [a, b] = edge;
        if (counts[0] == 1 && counts[1] == 1) continue;
        if (counts[0] + counts[1] == 1)
            return at_edge(surface, "its surface is open: it ends", a, b) +
                   "; close it, as a probe is solid";
        if (counts[0] + counts[1] == 2)
            return at_edge(surface, "two triangles of its surface face opposite sides", a, b) +
                   "; turn one of them";
        return at_edge(surface, "more than two triangles of its surface meet", a, b) +
               "; leave only the outer ones";
    }
    if (!(volume_of(surface) > 0.0)) return "the triangles of its surface face inwards: turn them";
    return "";
}

}  // namespace incise::cutting
