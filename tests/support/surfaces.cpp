// SPDX-License-Identifier: LGPL-3.0-or-later
#include "support/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <sstream>
#include <utility>
#include <vector>

namespace incise::test {

using topology::SurfaceData;

SurfaceData icosphere(const Vec3& centre, double radius, int num_divisions) {
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    SurfaceData s;
    s.points = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    s.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                   {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                   {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                   {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int i = 0; i < num_divisions; ++i) {
        std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> middles;
        const auto middle = [&](std::int64_t a, std::int64_t b) {
            const auto next = static_cast<std::int64_t>(s.points.size());
            const auto [place, is_new] = middles.try_emplace(std::minmax(a, b), next);
            if (is_new)
                s.points.push_back(0.5 * (s.points[static_cast<std::size_t>(a)] +
                                          s.points[static_cast<std::size_t>(b)]));
            return place->second;
        };
        std::vector<std::array<std::int64_t, 3>> finer;
        for (const auto& [a, b, c] : s.triangles) {
            const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        s.triangles = std::move(finer);
    }
    for (Vec3& x : s.points) x = centre + radius * x.normalized();
    return s;
}

SurfaceData box_surface(const Box& box) {
    SurfaceData s;
    for (int i = 0; i < 8; ++i)
        s.points.push_back(box.corner(static_cast<Box::CornerType>(i)));  // x runs first, then y
    s.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                   {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return s;
}

SurfaceData joined(const SurfaceData& a, const SurfaceData& b) {
    SurfaceData both = a;
    const auto first = static_cast<std::int64_t>(a.points.size());
    both.points.insert(both.points.end(), b.points.begin(), b.points.end());
    for (const auto& [p, q, r] : b.triangles)
        both.triangles.push_back({first + p, first + q, first + r});
    return both;
}

SurfaceData turned(SurfaceData surface) {
    for (auto& triangle : surface.triangles) std::swap(triangle[1], triangle[2]);
    return surface;
}

std::string stl_text(const SurfaceData& surface) {
    std::ostringstream text;
    text.precision(17);
    text << "solid s\n";
    for (const auto& triangle : surface.triangles) {
        text << "facet normal 0 0 0\nouter loop\n";
        for (const auto p : triangle)
            text << "vertex " << surface.points[static_cast<std::size_t>(p)].transpose() << '\n';
        text << "endloop\nendfacet\n";
    }
    text << "endsolid s\n";
    return text.str();
}

}  // namespace incise::test
