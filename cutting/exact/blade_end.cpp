// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/blade_end.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace incise::cutting {

namespace {

/// A point goes on as its neighbours do if its motion across the edge is small. It is small below
/// this share of the point's whole motion, or of the fastest motion of a point across the edge.
constexpr double least_share = 0.05;

/// Two segments count as equally near to a point if their distances differ by less than this share.
/// The point is then nearest to the place where the segments meet.
constexpr double rounding_of_distances = 1e-9;

Vec3 without(const Vec3& v, const Vec3& unit) { return v - v.dot(unit) * unit; }

}  // namespace

BladeEnd::BladeEnd(std::vector<Vec3> edge, const std::vector<Vec3>& motion)
    : edge_(std::move(edge)), ahead_(edge_.size(), Vec3::Zero()) {
    const std::size_t last = edge_.size() - 1;
    std::vector<Vec3> across = motion;
    std::vector<double> speeds(edge_.size());  // across that segment at the point which gives less
    for (std::size_t i = 0; i <= last; ++i) {
        const Vec3 before = i > 0 ? along(i - 1) : along(i), after = i < last ? along(i) : before;
        across[i] = without(motion[i], (before + after).stableNormalized());
        speeds[i] = std::min(without(across[i], before).norm(), without(across[i], after).norm());
    }
    const double fastest = *std::max_element(speeds.begin(), speeds.end());
    const auto is_known = [&](std::size_t i) {
        return i <= last && speeds[i] > least_share * std::max(fastest, motion[i].norm());
    };
    for (std::size_t i = 0; i <= last; ++i) {
        int count = 0;  // of the nearest points that move: one or two
        for (std::size_t away = 0; away <= last && count == 0; ++away)
            for (const std::size_t j : std::set{i - away, i + away}) {
                if (!is_known(j)) continue;
                ahead_[i] += across[j] / speeds[j];
                ++count;
            }
        if (count > 1) ahead_[i] /= count;
    }
}

Vec3 BladeEnd::along(std::size_t segment) const {
    return (edge_[segment + 1] - edge_[segment]).stableNormalized();
}

Vec3 BladeEnd::away_from_edge(const Vec3& x) const {
    Vec3 nearest = Vec3::Constant(std::numeric_limits<double>::infinity());
    for (std::size_t s = 0; s + 1 < edge_.size(); ++s)
        if (const Vec3 away = x - point_at(s, nearest_place(s, x));
            !(away.squaredNorm() >= nearest.squaredNorm()))
            nearest = away;
    return nearest;
}

double BladeEnd::distance_ahead(const Vec3& x) const {
    const Vec3 nearest = away_from_edge(x);
    Vec3 direction = Vec3::Zero();
    for (std::size_t s = 0; s + 1 < edge_.size(); ++s) {
        const double t = nearest_place(s, x);
        const double farther = (x - point_at(s, t)).norm() - nearest.norm();
        if (farther > rounding_of_distances * nearest.norm()) continue;
        const Vec3 motion = (1.0 - t) * ahead_[s] + t * ahead_[s + 1];
        direction += without(motion, along(s)).stableNormalized();
    }
    return nearest.dot(direction.stableNormalized());
}

/// Returns the parameter of the point of the segment that is nearest to x: 0 at its first end, 1 at
/// the other.
double BladeEnd::nearest_place(std::size_t segment, const Vec3& x) const {
    const Vec3 way = edge_[segment + 1] - edge_[segment];
    const double square = way.squaredNorm();
    return square > 0.0 ? std::clamp((x - edge_[segment]).dot(way) / square, 0.0, 1.0) : 0.0;
}

Vec3 BladeEnd::point_at(std::size_t segment, double place) const {
    return (1.0 - place) * edge_[segment] + place * edge_[segment + 1];
}

std::vector<Vec3> BladeEnd::edge_after(double distance) const {
    std::vector<Vec3> there = edge_;
    for (std::size_t i = 0; i < there.size(); ++i) there[i] += distance * ahead_[i];
    return there;
}

}  // namespace incise::cutting
