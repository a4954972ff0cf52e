// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/surface_interior.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <cmath>

namespace incise::tetmesh {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

Kernel::Point_2 flat(const Vec3& x) { return {x.x(), x.y()}; }
Kernel::Point_3 solid(const Vec3& x) { return {x.x(), x.y(), x.z()}; }

/// True if the edge, seen from above, is to the right of the point. An edge through the point is
/// not, and ends belong to the edge above them: so neighbours agree.
bool is_to_the_right(const Vec3& a, const Vec3& b, const Vec3& x) {
    const bool ends_above = b.y() > x.y();
    if ((a.y() > x.y()) == ends_above) return false;
    if (std::max(a.x(), b.x()) < x.x()) return false;
    if (std::min(a.x(), b.x()) > x.x()) return true;
    const auto turn = CGAL::orientation(flat(a), flat(b), flat(x));
    return turn == (ends_above ? CGAL::LEFT_TURN : CGAL::RIGHT_TURN);
}

}  // namespace

SurfaceInterior::SurfaceInterior(const topology::SurfaceData& surface,
                                 std::span<const std::size_t> triangles) {
    triangles_.reserve(triangles.size());
    for (const std::size_t t : triangles) {
        auto& corners = triangles_.emplace_back();
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = surface.points[static_cast<std::size_t>(surface.triangles[t][k])];
            box_.extend(corners[k]);
        }
    }
    // As many columns as triangles, at most: then a column has a few triangles.
    constexpr double max_columns = 2048.0;
    const double side = std::sqrt(static_cast<double>(triangles_.size()));
    for (std::size_t a = 0; a < 2; ++a) {
        const auto axis = static_cast<Eigen::Index>(a);
        num_columns_[a] = static_cast<std::size_t>(std::clamp(side, 1.0, max_columns));
        widths_[a] = box_.sizes()[axis] / static_cast<double>(num_columns_[a]);
    }
    const auto for_columns = [&](const Triangle& t, const auto& visit) {
        Box of_triangle;
        for (const Vec3& x : t) of_triangle.extend(x);
        const auto first_x = column(0, of_triangle.min().x()),
                   last_x = column(0, of_triangle.max().x()),
                   first_y = column(1, of_triangle.min().y()),
                   last_y = column(1, of_triangle.max().y());
        for (auto j = first_y; j <= last_y; ++j)
            for (auto i = first_x; i <= last_x; ++i) visit(i + j * num_columns_[0]);
    };
    begins_.assign(num_columns_[0] * num_columns_[1] + 1, 0);
    for (const Triangle& t : triangles_) for_columns(t, [&](std::size_t c) { ++begins_[c + 1]; });
    for (std::size_t c = 1; c < begins_.size(); ++c) begins_[c] += begins_[c - 1];
    listed_.resize(begins_.back());
    auto next = begins_;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for_columns(triangles_[t],
                    [&](std::size_t c) { listed_[next[c]++] = static_cast<std::uint32_t>(t); });
}

std::size_t SurfaceInterior::column(std::size_t axis, double place) const {
    const double low = box_.min()[static_cast<Eigen::Index>(axis)];
    const double number = std::floor((place - low) / widths_[axis]);
    return static_cast<std::size_t>(
        std::clamp(number, 0.0, static_cast<double>(num_columns_[axis] - 1)));
}

Side SurfaceInterior::side_of(const Vec3& x) const {
    if (!box_.contains(x)) return Side::outside;
    bool is_inside = false;
    const auto c = column(0, x.x()) + column(1, x.y()) * num_columns_[0];
    for (auto i = begins_[c]; i < begins_[c + 1]; ++i) {
        const auto& [p, q, r] = triangles_[listed_[i]];
        if (std::max({p.z(), q.z(), r.z()}) < x.z()) continue;
        const int crossings =
            is_to_the_right(p, q, x) + is_to_the_right(q, r, x) + is_to_the_right(r, p, x);
        if (crossings != 1) continue;
        const auto side = CGAL::orientation(solid(p), solid(q), solid(r), solid(x));
        if (side == CGAL::COPLANAR) return Side::on;
        const auto turn = CGAL::orientation(flat(p), flat(q), flat(r));
        const bool is_above = (side == CGAL::POSITIVE) != (turn == CGAL::LEFT_TURN);
        if (is_above) is_inside = !is_inside;
    }
    return is_inside ? Side::inside : Side::outside;
}

}  // namespace incise::tetmesh
