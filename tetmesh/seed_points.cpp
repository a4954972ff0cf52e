// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/seed_points.h"

#include <cmath>
#include <cstddef>
#include <numbers>
#include <utility>

namespace incise::tetmesh {

namespace {

/// Returns unit vectors in all directions: points of a spiral on the sphere.
std::vector<Vec3> directions() {
    constexpr int num_directions = 150;
    std::vector<Vec3> all;
    for (int i = 0; i < num_directions; ++i) {
        const double z = 1.0 - (2.0 * i + 1.0) / num_directions;
        const double angle = 2.0 * std::numbers::pi * i / std::numbers::phi;
        const double radius = std::sqrt(1.0 - z * z);
        all.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return all;
}

/// Returns points of the surface at a distance from a point: on the arc from each direction that
/// points into the region to the next one that does not.
std::vector<Vec3> points_at(double distance, const Vec3& x, int region,
                            const std::function<int(const Vec3&)>& region_at) {
    const auto is_in = [&](const Vec3& direction) {
        return region_at(x + distance * direction) == region;
    };
    std::vector<Vec3> in, out, points;
    for (const Vec3& direction : directions()) (is_in(direction) ? in : out).push_back(direction);
    for (Vec3 a : in) {
        Vec3 b = -a;
        for (const Vec3& other : out)
            if (other.dot(a) > b.dot(a)) b = other;
        if ((a + b).norm() < 0.1) continue;  // no arc between opposite directions
        constexpr int num_halvings = 40;
        for (int i = 0; i < num_halvings; ++i) {
            const Vec3 middle = (a + b).normalized();
            (is_in(middle) ? a : b) = middle;
        }
        points.push_back(x + distance * b);
    }
    return points;
}

}  // namespace

std::vector<Vec3> seed_points(const Vec3& x, double length, int region,
                              const std::function<int(const Vec3&)>& region_at) {
    constexpr double least_edge = 0.5;  // of the triangle, over the distance of its corners from x
    for (const double distance : {length, 0.5 * length, 0.25 * length}) {
        const auto points = points_at(distance, x, region, region_at);
        double best = (1.0 - least_edge) * distance;
        std::vector<Vec3> seeds;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = i + 1; j < points.size(); ++j) {
                const double off = std::abs((points[i] - points[j]).norm() - distance);
                if (!(off < best)) continue;
                best = off;
                seeds = {points[i], points[j]};
            }
        if (!seeds.empty()) return seeds;
    }
    return {};
}

}  // namespace incise::tetmesh
