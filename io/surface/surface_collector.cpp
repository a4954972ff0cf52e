// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/surface/surface_collector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "incise/base/error.h"
#include "incise/io/files/number_text.h"
#include "incise/topology/flat_triangles.h"

namespace incise::io {

namespace {

// Products of three such lengths, and sums of many such products, are still finite.
constexpr double largest_coordinate = 1e100;

constexpr std::array<const char*, 3> axis_names = {"x", "y", "z"};

}  // namespace

void SurfaceCollector::add_point(const Vec3& point) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double value = point[static_cast<Eigen::Index>(i)];
        if (!(std::abs(value) <= largest_coordinate))
            scanner_.fail(std::string("coordinate ") + axis_names[i] + " of point " +
                          std::to_string(num_points()) + " is " + shown(value) +
                          "; it must be a number from -1e100 to 1e100");
    }
    surface_.points.push_back(point);
}

void SurfaceCollector::add_point(std::span<const std::string_view> words) {
    if (words.size() < 3)
        scanner_.fail("point " + std::to_string(num_points()) + " has " +
                      std::to_string(words.size()) + " coordinates; it must have 3");
    Vec3 point;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto value = parse_number<double>(words[i]);
        if (!value) scanner_.fail_expected(std::string("coordinate ") + axis_names[i], words[i]);
        point[static_cast<Eigen::Index>(i)] = *value;
    }
    add_point(point);
}

void SurfaceCollector::check_corner(std::int64_t corner, std::uint64_t num_points) const {
    if (corner < 0 || static_cast<std::uint64_t>(corner) >= num_points)
        scanner_.fail("point index " + std::to_string(corner) + " is out of range (" +
                      std::to_string(num_points) + " points, numbered from 0)");
}

void SurfaceCollector::add_polygon(std::span<const std::int64_t> corners) {
    if (corners.size() < 3)
        scanner_.fail("a face has " + std::to_string(corners.size()) +
                      " corners; it must have at least 3");
    for (std::size_t i = 2; i < corners.size(); ++i)
        surface_.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

void SurfaceCollector::merge_equal_points() {
    auto& [points, triangles] = surface_;
    for (auto& point : points) point.array() += 0.0;  // changes -0 to 0

    std::vector<std::size_t> order(points.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&points = points](std::size_t a, std::size_t b) {
        for (Eigen::Index i = 0; i < 3; ++i)
            if (points[a][i] != points[b][i]) return points[a][i] < points[b][i];
        return a < b;
    });
    // Among equal points, the first in `order` is the first in the file.
    std::vector<std::size_t> first_equal(points.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool is_new = i == 0 || points[order[i]] != points[order[i - 1]];
        first_equal[order[i]] = is_new ? order[i] : first_equal[order[i - 1]];
    }

    std::vector<std::int64_t> old_to_new(points.size());
    std::size_t num_kept = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (first_equal[p] == p) {
            points[num_kept] = points[p];
            old_to_new[p] = static_cast<std::int64_t>(num_kept++);
        } else {
            old_to_new[p] = old_to_new[first_equal[p]];
        }
    }
    points.resize(num_kept);
    for (auto& triangle : triangles)
        for (auto& corner : triangle) corner = old_to_new[static_cast<std::size_t>(corner)];
}

SurfaceFile SurfaceCollector::finish() {
    auto& [points, triangles] = surface_;
    if (triangles.empty())
        throw InputError(file_.name() + ": holds no triangles; export a surface of triangles");
    const auto num_all = triangles.size();
    surface_ = topology::without_flat_triangles(std::move(surface_));
    const auto num_dropped = num_all - triangles.size();
    if (triangles.empty())
        throw InputError(file_.name() + ": none of the " + std::to_string(num_all) +
                         " triangles has three corners and an area; check the scale and the "
                         "digits of the export");
    SurfaceFile result;
    if (num_dropped > 0)
        result.warnings.push_back("left out " + std::to_string(num_dropped) + " of " +
                                  std::to_string(num_all) +
                                  " triangles, which have repeated corners or no area");
    result.surface = std::exchange(surface_, {});
    return result;
}

}  // namespace incise::io
