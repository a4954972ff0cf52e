// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/blade_end.h"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

namespace incise::cutting {

namespace {

/// A point that moves across the edge by less than this share of its motion, or of that of the
/// fastest point, goes on as its neighbours do.
constexpr double least_share = 0.05;

Vec3 without(const Vec3& v, const Vec3& unit) { return v - v.dot(unit) * unit; }

}  // namespace

BladeEnd::BladeEnd(std::vector<Vec3> edge, const std::vector<Vec3>& motion)
    : edge_(std::move(edge)), ahead_(edge_.size(), Vec3::Zero()) {
    const std::size_t last = edge_.size() - 1;
    std::vector<double> speeds;  // across the edge
    for (std::size_t i = 0; i <= last; ++i) {
        Vec3 tangent = Vec3::Zero();
        if (i > 0) tangent += along(i - 1);
        if (i < last) tangent += along(i);
        speeds.push_back(without(motion[i], tangent.stableNormalized()).norm());
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
                ahead_[i] += motion[j] / speeds[j];
                ++count;
            }
        if (count > 1) ahead_[i] /= count;
    }
}

Vec3 BladeEnd::along(std::size_t segment) const {
    return (edge_[segment + 1] - edge_[segment]).stableNormalized();
}

double BladeEnd::distance_ahead(const Vec3& x) const {
    double nearest = std::numeric_limits<double>::infinity(), ahead = 0.0;
    for (std::size_t s = 0; s + 1 < edge_.size(); ++s) {
        const Vec3 segment = edge_[s + 1] - edge_[s], from = x - edge_[s];
        const double square = segment.squaredNorm();
        const double t = square > 0.0 ? std::clamp(from.dot(segment) / square, 0.0, 1.0) : 0.0;
        const Vec3 away = from - t * segment;
        if (away.squaredNorm() >= nearest) continue;
        nearest = away.squaredNorm();
        const Vec3 motion = (1.0 - t) * ahead_[s] + t * ahead_[s + 1];
        ahead = away.dot(without(motion, along(s)).stableNormalized());
    }
    return ahead;
}

SweptEdge BladeEnd::continuation(double distance) const {
    std::vector<Vec3> there = edge_;
    for (std::size_t i = 0; i < there.size(); ++i) there[i] += distance * ahead_[i];
    return {edge_, there};
}

}  // namespace incise::cutting
