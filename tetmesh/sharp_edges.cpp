// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/sharp_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include "tetmesh/coordinate_tolerance.h"

namespace incise::tetmesh {

namespace {

using Edge = std::array<std::size_t, 2>;  // numbers of points, the lower one first

Edge edge_of(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

/// Points that are nearer to each other than a tolerance are one.
class MergedPoints {
  public:
    explicit MergedPoints(double tolerance) : tolerance_(tolerance) {}

    std::size_t number_of(const Vec3& x) {
        const auto cell = [&](Eigen::Index axis) {
            return static_cast<std::int64_t>(std::floor(x[axis] / (4.0 * tolerance_)));
        };
        for (std::int64_t i = -1; i <= 1; ++i)
            for (std::int64_t j = -1; j <= 1; ++j)
                for (std::int64_t k = -1; k <= 1; ++k) {
                    const auto found = known_.find({cell(0) + i, cell(1) + j, cell(2) + k});
                    if (found == known_.end()) continue;
                    for (const std::size_t p : found->second)
                        if ((points[p] - x).norm() <= tolerance_) return p;
                }
        known_[{cell(0), cell(1), cell(2)}].push_back(points.size());
        points.push_back(x);
        return points.size() - 1;
    }

    std::vector<Vec3> points;

  private:
    double tolerance_;
    std::map<std::array<std::int64_t, 3>, std::vector<std::size_t>> known_;
};

Vec3 normal_of(const topology::SurfaceData& surface, std::size_t t) {
    const auto at = [&](std::size_t k) {
        return surface.points[static_cast<std::size_t>(surface.triangles[t][k])];
    };
    return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

void collect_edges(const topology::SurfaceParts& surface, double angle, MergedPoints& points,
                   std::set<Edge>& edges) {
    std::map<std::pair<std::int64_t, std::int64_t>, std::size_t> waiting;
    const auto& triangles = surface.surface.triangles;
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto a = triangles[t][k], b = triangles[t][(k + 1) % 3];
            const auto [it, is_new] = waiting.try_emplace(std::minmax({a, b}), t);
            if (is_new) continue;
            const Vec3 m = normal_of(surface.surface, it->second),
                       n = normal_of(surface.surface, t);
            if (std::atan2(m.cross(n).norm(), m.dot(n)) < angle) continue;
            const auto p = points.number_of(surface.surface.points[static_cast<std::size_t>(a)]),
                       q = points.number_of(surface.surface.points[static_cast<std::size_t>(b)]);
            if (p != q) edges.insert(edge_of(p, q));
        }
}

/// Where two edges come nearest to each other: the shares of their lengths.
std::array<double, 2> nearest_shares(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Vec3 u = b - a, v = d - c, w = a - c;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
    const double det = uu * vv - uv * uv;
    if (det <= 1e-12 * uu * vv) return {-1.0, -1.0};  // parallel: only ends can divide
    return {(uv * v.dot(w) - vv * u.dot(w)) / det, (uu * v.dot(w) - uv * u.dot(w)) / det};
}

/// Divides edges where others end on them or cross them.
std::set<Edge> divided(const std::set<Edge>& edges, MergedPoints& points, double tolerance) {
    struct Span {
        double low, high;
        Edge edge;
        std::vector<std::size_t> cuts = {};
    };
    std::vector<Span> spans;
    for (const Edge& e : edges) {
        const auto [low, high] = std::minmax({points.points[e[0]].x(), points.points[e[1]].x()});
        spans.push_back({low - tolerance, high + tolerance, e});
    }
    std::ranges::stable_sort(spans, {}, &Span::low);
    const auto cut_at_end = [&](Span& span, std::size_t p) {
        const Vec3 a = points.points[span.edge[0]], u = points.points[span.edge[1]] - a;
        const double share = u.dot(points.points[p] - a) / u.squaredNorm();
        if (share > 0.0 && share < 1.0 && (a + share * u - points.points[p]).norm() <= tolerance)
            span.cuts.push_back(p);
    };
    for (std::size_t i = 0; i < spans.size(); ++i)
        for (std::size_t k = i + 1; k < spans.size() && spans[k].low <= spans[i].high; ++k) {
            for (const std::size_t p : spans[k].edge) cut_at_end(spans[i], p);
            for (const std::size_t p : spans[i].edge) cut_at_end(spans[k], p);
            const Vec3 a = points.points[spans[i].edge[0]], b = points.points[spans[i].edge[1]],
                       c = points.points[spans[k].edge[0]], d = points.points[spans[k].edge[1]];
            const auto [s, t] = nearest_shares(a, b, c, d);
            if (s <= 0.0 || s >= 1.0 || t <= 0.0 || t >= 1.0) continue;
            const Vec3 x = a + s * (b - a), y = c + t * (d - c);
            if ((x - y).norm() > tolerance) continue;
            const auto p = points.number_of(0.5 * (x + y));
            spans[i].cuts.push_back(p);
            spans[k].cuts.push_back(p);
        }

    std::set<Edge> result;
    for (Span& span : spans) {
        const Vec3 a = points.points[span.edge[0]], u = points.points[span.edge[1]] - a;
        span.cuts.push_back(span.edge[0]);
        span.cuts.push_back(span.edge[1]);
        std::ranges::sort(span.cuts, {},
                          [&](std::size_t p) { return u.dot(points.points[p] - a); });
        for (std::size_t k = 1; k < span.cuts.size(); ++k)
            if (span.cuts[k - 1] != span.cuts[k])
                result.insert(edge_of(span.cuts[k - 1], span.cuts[k]));
    }
    return result;
}

}  // namespace

std::vector<std::vector<Vec3>> sharp_edges(const std::vector<topology::SurfaceParts>& surfaces,
                                           double angle) {
    std::size_t num_parts = 0;
    for (const auto& surface : surfaces) num_parts += surface.parts.size();
    const double tolerance = coordinate_tolerance(box_of(surfaces));
    MergedPoints points(tolerance);
    std::set<Edge> edges;
    for (const auto& surface : surfaces) collect_edges(surface, angle, points, edges);
    if (num_parts > 1) edges = divided(edges, points, tolerance);

    std::vector<std::vector<std::size_t>> neighbors(points.points.size());
    for (const Edge& e : edges) {
        neighbors[e[0]].push_back(e[1]);
        neighbors[e[1]].push_back(e[0]);
    }
    const auto is_end = [&](std::size_t p) {
        if (neighbors[p].size() != 2) return true;
        const Vec3 u = points.points[p] - points.points[neighbors[p][0]],
                   v = points.points[neighbors[p][1]] - points.points[p];
        return std::atan2(u.cross(v).norm(), u.dot(v)) >= angle;
    };
    std::vector<std::vector<Vec3>> lines;
    const auto follow = [&](std::size_t from, std::size_t to) {
        if (edges.erase(edge_of(from, to)) == 0) return;
        auto& line = lines.emplace_back();
        line = {points.points[from], points.points[to]};
        const std::size_t first = from;
        while (to != first && !is_end(to)) {
            const auto next = neighbors[to][0] == from ? neighbors[to][1] : neighbors[to][0];
            if (edges.erase(edge_of(to, next)) == 0) break;
            from = to;
            to = next;
            line.push_back(points.points[to]);
        }
    };
    for (std::size_t p = 0; p < neighbors.size(); ++p)
        if (is_end(p))
            for (const std::size_t q : neighbors[p]) follow(p, q);
    while (!edges.empty()) {  // what is left are closed lines without an end
        const Edge e = *edges.begin();
        follow(e[0], e[1]);
    }
    return lines;
}

}  // namespace incise::tetmesh
