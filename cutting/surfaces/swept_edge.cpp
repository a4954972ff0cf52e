// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/swept_edge.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace incise::cutting {

namespace {

/// Returns a bound of the rounding errors in the heights of points in the box along the normal.
double rounding_of_heights(const Vec3& normal, const Box& box) {
    return 1e-12 * normal.cwiseAbs().dot(box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()));
}

/// Share of the height of a hull. What is nearer to the hull than this counts as in it. Earlier
/// cuts are recognized to the same precision (SnapHistory::rounding).
constexpr double hull_margin = 1e-6;

}  // namespace

SweptEdge::SweptEdge(std::vector<Vec3> before, std::vector<Vec3> after) {
    for (std::size_t s = 0; s + 1 < before.size(); ++s) {
        segments_.push_back({{before[s], after[s]}, {before[s + 1], after[s + 1]}});
        const Vec3 across = after[s + 1] - before[s], back = after[s] - before[s + 1];
        Bounds bounds{Box(before[s]), across.cross(back), 0.0, 0.0};
        bounds.low = bounds.high = bounds.normal.dot(before[s]);
        for (const Vec3& x : {after[s], before[s + 1], after[s + 1]}) {
            bounds.box.extend(x);
            bounds.low = std::min(bounds.low, bounds.normal.dot(x));
            bounds.high = std::max(bounds.high, bounds.normal.dot(x));
        }
        const double rounding = rounding_of_heights(bounds.normal, bounds.box);
        bounds.low -= rounding;
        bounds.high += rounding;
        bounds_.push_back(bounds);
    }
}

bool SweptEdge::may_meet(const Box& box) const {
    const Vec3 centre = box.center(), half = 0.5 * box.sizes();
    for (const Bounds& bounds : bounds_) {
        if (!bounds.box.intersects(box)) continue;
        const double middle = bounds.normal.dot(centre);
        const double radius =
            bounds.normal.cwiseAbs().dot(half) + rounding_of_heights(bounds.normal, box);
        if (middle + radius >= bounds.low && middle - radius <= bounds.high) return true;
    }
    return false;
}

bool SweptEdge::may_meet_hull(std::span<const MovingPoint> points) const {
    Box box;
    for (const MovingPoint& x : points) box.extend(x[0]).extend(x[1]);
    return std::any_of(bounds_.begin(), bounds_.end(), [&](const Bounds& bounds) {
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (const MovingPoint& x : points) {
            const double from = bounds.normal.dot(x[0]), to = bounds.normal.dot(x[1]);
            low = std::min({low, from, to});
            high = std::max({high, from, to});
        }
        const double margin = hull_margin * (high - low) + rounding_of_heights(bounds.normal, box);
        return high + margin >= bounds.low && low - margin <= bounds.high;
    });
}

void SweptEdge::append_crossings(const MovingPoint& a, const MovingPoint& b,
                                 std::vector<Crossing>& crossings) const {
    Box path(a[0]);
    path.extend(a[1]).extend(b[0]).extend(b[1]);
    for (std::size_t s = 0; s < segments_.size(); ++s) {
        const Bounds& bounds = bounds_[s];
        if (!bounds.box.intersects(path)) continue;
        const auto height = [&](const Vec3& x) { return bounds.normal.dot(x); };
        const auto [low, high] =
            std::minmax({height(a[0]), height(a[1]), height(b[0]), height(b[1])});
        const double rounding = rounding_of_heights(bounds.normal, path);
        if (low - rounding > bounds.high || high + rounding < bounds.low) continue;
        cutting::append_crossings({a, b}, segments_[s], crossings);
    }
}

std::optional<bool> SweptEdge::ends_inside(const std::array<MovingPoint, 3>& triangle) const {
    Box box(triangle[0][1]);
    box.extend(triangle[1][1]).extend(triangle[2][1]);
    bool is_odd = false;
    for (const MovingSegment& s : segments_)
        if (box.intersects(Box(s.a[1].cwiseMin(s.b[1]), s.a[1].cwiseMax(s.b[1]))))
            is_odd ^= pierces(s.a[1], s.b[1], {triangle[0][1], triangle[1][1], triangle[2][1]});
    return is_odd;
}

std::optional<Vec3> SweptEdge::end_point_inside(const std::array<MovingPoint, 3>& triangle) const {
    const Vec3 &a = triangle[0][1], &b = triangle[1][1], &c = triangle[2][1];
    const Vec3 normal = (b - a).cross(c - a);
    for (const MovingSegment& s : segments_) {
        if (!pierces(s.a[1], s.b[1], {a, b, c})) continue;
        const double from = normal.dot(a - s.a[1]), length = normal.dot(s.b[1] - s.a[1]);
        return s.a[1] + (length != 0.0 ? from / length : 0.5) * (s.b[1] - s.a[1]);
    }
    return std::nullopt;
}

bool SweptEdge::ends_near(const Vec3& x, double radius) const {
    for (const MovingSegment& s : segments_) {
        const Vec3 along = s.b[1] - s.a[1], from = x - s.a[1];
        const double square = along.squaredNorm();
        const double t = square > 0.0 ? std::clamp(from.dot(along) / square, 0.0, 1.0) : 0.0;
        if ((from - t * along).squaredNorm() < radius * radius) return true;
    }
    return false;
}

}  // namespace incise::cutting
