// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
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

double volume_of_triangles(const SurfaceData& surface, std::span<const Corners> triangles) {
    if (triangles.empty()) return 0.0;
    const Vec3& o = point(surface, triangles[0][0]);
    double sum = 0.0;
    for (const auto& [a, b, c] : triangles)
        sum += (point(surface, a) - o).dot((point(surface, b) - o).cross(point(surface, c) - o));
    return sum / 6.0;
}

/// Returns the triangles of each part of a surface. Triangles with a common point are of one part.
std::vector<std::vector<std::size_t>> parts_of(const SurfaceData& surface) {
    std::vector<std::size_t> root(surface.points.size());
    std::iota(root.begin(), root.end(), std::size_t{0});
    const auto root_of = [&](std::int64_t p) {
        auto i = static_cast<std::size_t>(p);
        while (root[i] != i) i = root[i] = root[root[i]];
        return i;
    };
    for (const Corners& t : surface.triangles)
        for (std::size_t k = 1; k < 3; ++k) root[root_of(t[k])] = root_of(t[0]);
    std::map<std::size_t, std::size_t> number;
    std::vector<std::vector<std::size_t>> parts;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto [it, is_new] =
            number.try_emplace(root_of(surface.triangles[t][0]), parts.size());
        if (is_new) parts.emplace_back();
        parts[it->second].push_back(t);
    }
    return parts;
}

/// Returns the parts that face inwards and are no cavities of others.
std::vector<std::vector<std::size_t>> parts_inside_out(const SurfaceData& surface) {
    const auto parts = parts_of(surface);
    const auto corners_of = [&](const std::vector<std::size_t>& part) {
        std::vector<Corners> corners;
        corners.reserve(part.size());
        for (const std::size_t t : part) corners.push_back(surface.triangles[t]);
        return corners;
    };
    std::vector<std::vector<std::size_t>> found;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (volume_of_triangles(surface, corners_of(parts[i])) >= 0.0) continue;
        const Vec3& x = point(surface, surface.triangles[parts[i].front()][0]);
        bool is_cavity = false;
        for (std::size_t k = 0; k < parts.size() && !is_cavity; ++k) {
            if (k == i) continue;
            SurfaceData other;
            other.points = surface.points;
            other.triangles = corners_of(parts[k]);
            is_cavity = volume_of(other) > 0.0 && encloses(other, x);
        }
        if (!is_cavity) found.push_back(parts[i]);
    }
    return found;
}

}  // namespace

double volume_of(const SurfaceData& surface) {
    return volume_of_triangles(surface, surface.triangles);
}

// The solid angle of the surface is that of a full turn inside, and 0 outside.
// Source: van Oosterom, Strackee 1983.
bool encloses(const SurfaceData& surface, const Vec3& x) {
    double half_angles = 0.0;
    for (const Corners& t : surface.triangles) {
        const Vec3 a = point(surface, t[0]) - x, b = point(surface, t[1]) - x,
                   c = point(surface, t[2]) - x;
        const double la = a.norm(), lb = b.norm(), lc = c.norm();
        half_angles += std::atan2(a.dot(b.cross(c)),
                                  la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
    }
    return half_angles > std::numbers::pi;
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
    const auto inside_out = parts_inside_out(solid.surface);
    was_turned = !inside_out.empty();
    for (const auto& part : inside_out)
        for (const std::size_t t : part)
            std::swap(solid.surface.triangles[t][1], solid.surface.triangles[t][2]);
    return solid;
}

Solid solid_of(const Cuboid& box) {
    Solid solid;
    for (int i = 0; i < 8; ++i)  // x runs first, then y
        solid.surface.points.push_back(
            0.5 * box.size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
    solid.surface.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                               {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
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
    if (!parts_inside_out(surface).empty() || !(volume_of(surface) > 0.0))
        return "the triangles of a part of its surface face inwards: turn them";
    return "";
}

}  // namespace incise::cutting
