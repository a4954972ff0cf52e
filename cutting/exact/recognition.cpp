// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/recognition.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

namespace incise::cutting {

namespace {

/// How far nodes may have moved across a surface that comes again, as a share of the size of
/// elements. What has moved farther may be another part of the tissue.
constexpr double near = 0.1;

class Recognizer {
  public:
    Recognizer(const TissueMotion& tissue, const CutSurface& surface,
               const SnapHistory& snap_history)
        : tissue_(tissue), surface_(surface), snap_history_(snap_history) {}

    /// Puts the node on the front if the surface passes by it as one of its records says. `length`
    /// is that of the longest edge there, m. Returns the record if the node is frozen, or null.
    const CutRecord* look_at(VertexId n, double length, CutFront& front) const {
        for (const CutRecord& record : snap_history_.of(n)) {
            const bool may_freeze = is_where_it_was(n, record, length);
            if (front.is_on(n) && !may_freeze) continue;
            const std::optional<Crossing> intersection =
                may_freeze ? intersection_near(record, length)
                           : intersection_by(n, record.to_surface, record.normal, length);
            // Another surface through the same point is another cut.
            if (!intersection || !is_along(record, intersection->normal)) continue;
            // An exact node that has moved off the surface is only near it.
            const bool is_exact = record.is_exact && (!may_freeze || has_stayed(n, record, length));
            if (!front.is_on(n)) front.put_on(n, is_exact, length, record.rank);
            if (!may_freeze) continue;
            front.freeze(n);
            return &record;
        }
        return nullptr;
    }

    /// Returns how far the node has moved across the surface since the cut of the record, m.
    Vec3 motion_across(VertexId n, const CutRecord& record) const {
        return record.normal.dot(tissue_.after[n.index()] - record.place) * record.normal;
    }
    /// True if the surface would be on the other side of the node without this motion.
    bool is_passed_over(VertexId n, const Vec3& motion) const {
        const Vec3 x = tissue_.after[n.index()], without = x - motion;
        std::vector<Crossing> crossings;
        surface_.append_crossings({x, x}, {without, without}, crossings);
        return crossings.size() % 2 == 1;
    }

  private:
    /// Returns the intersection of the surface with the place at which a cut passed by the node.
    std::optional<Crossing> intersection_by(VertexId n, const Vec3& to_surface, const Vec3& normal,
                                            double length) const {
        return intersection_at(
            {tissue_.before[n.index()] + to_surface, tissue_.after[n.index()] + to_surface}, normal,
            length);
    }
    std::optional<Crossing> intersection_at(const MovingPoint& x, const Vec3& normal,
                                            double length) const {
        const Vec3 short_way = SnapHistory::rounding * length * normal;
        const auto beside = [&](const Vec3& way) -> MovingPoint {
            return {x[0] + way, x[1] + way};
        };
        std::vector<Crossing> crossings;
        surface_.append_crossings(beside(-short_way), beside(short_way), crossings);
        return crossings.size() % 2 == 1 ? std::optional(crossings.front()) : std::nullopt;
    }

    /// Returns the intersection at that place or beside it. At a crease of the surface, rounding
    /// may have put the place beyond the crease. Prefers an intersection with the direction of the
    /// earlier cut.
    std::optional<Crossing> intersection_near(const CutRecord& record, double length) const {
        const Vec3 u = 2.0 * SnapHistory::rounding * length * record.normal.unitOrthogonal();
        const Vec3 v = record.normal.cross(u);
        std::optional<Crossing> other;
        for (const int s : {0, 1, -1})
            for (const int t : {0, 1, -1}) {
                const Vec3 x = record.place + record.to_surface + s * u + t * v;
                auto intersection = intersection_at({x, x}, record.normal, length);
                if (intersection && is_along(record, intersection->normal)) return intersection;
                if (!other) other = intersection;
            }
        return other;
    }

    /// True if the surface may be that of the record, and the node has hardly moved across it.
    bool is_where_it_was(VertexId n, const CutRecord& record, double length) const {
        const double size = std::max(length, snap_history_.uncut_size(n));
        return surface_.identity() != no_identity && record.surface == surface_.identity() &&
               std::abs(record.normal.dot(tissue_.after[n.index()] - record.place)) <= near * size;
    }
    bool has_stayed(VertexId n, const CutRecord& record, double length) const {
        return (tissue_.after[n.index()] - record.place).norm() <= SnapHistory::rounding * length;
    }
    static bool is_along(const CutRecord& record, const Vec3& normal) {
        return record.normal.cross(normal).norm() < SnapHistory::rounding * normal.norm();
    }

    const TissueMotion& tissue_;
    const CutSurface& surface_;
    const SnapHistory& snap_history_;
};

/// A node on the earlier cut, and how far it has moved across the surface since, m.
struct Frozen {
    VertexId node;
    Vec3 motion;
    std::uint64_t rank;
};

/// Returns the edges of the elements from which a surface that comes again may have moved away.
EdgeList edges_beside(const TissueMotion& tissue, const CutSurface& surface,
                      const SnapHistory& snap_history) {
    const Vec3 margin = Vec3::Constant(near * snap_history.largest_uncut_size());
    const auto may_meet = [&](const Box& box) {
        return surface.may_meet(Box(box.min() - margin, box.max() + margin));
    };
    EdgeList edges;
    tissue.for_each_near(may_meet, [&](CellId e) {
        const topology::CellTraits& t = traits(tissue.mesh.kind(e));
        const auto corners = tissue.mesh.corners(e);
        for (int k = 0; k < t.num_edges; ++k) {
            const auto [p, q] = t.edges[static_cast<std::size_t>(k)];
            edges.add(edge_between(corners[static_cast<std::size_t>(p)],
                                   corners[static_cast<std::size_t>(q)]),
                      e);
        }
    });
    return edges;
}

}  // namespace

void recognize(const TissueMotion& tissue, const CutSurface& surface,
               std::span<const EdgeList::Entry> edges, const SnapHistory& snap_history,
               CutFront& front) {
    if (snap_history.is_empty()) return;
    EdgeList beside;
    if (surface.identity() != no_identity) {
        beside = edges_beside(tissue, surface, snap_history);
        edges = beside.entries();
    }
    const auto is_new = [&](VertexId n) { return !snap_history.of(n).empty() && !front.is_on(n); };
    std::vector<Edge> scarred;
    for (const auto& [edge, element] : edges)
        if (is_new(edge.a) || is_new(edge.b)) scarred.push_back(edge);
    if (scarred.empty()) return;
    // Sorted, so that the order does not depend on which elements are near.
    std::sort(scarred.begin(), scarred.end());

    std::unordered_map<VertexId, double> lengths;  // of the longest edge at each node, m
    for (const auto& [edge, element] : edges) {
        const double length =
            (tissue.mesh.rest_position(edge.b) - tissue.mesh.rest_position(edge.a)).norm();
        for (const VertexId n : {edge.a, edge.b}) lengths[n] = std::max(lengths[n], length);
    }

    const Recognizer recognizer(tissue, surface, snap_history);
    std::vector<Frozen> frozen;
    for (const Edge& edge : scarred)
        for (const VertexId n : {edge.a, edge.b}) {
            if (front.is_on(n)) continue;
            if (const CutRecord* record = recognizer.look_at(n, lengths.at(n), front))
                frozen.push_back({n, recognizer.motion_across(n, *record), record->rank});
        }

    // Nodes beside the faces of the earlier cut that the motion has carried through the surface.
    std::unordered_map<VertexId, std::vector<VertexId>> neighbors;
    if (!frozen.empty())
        for (const auto& [edge, element] : edges) {
            neighbors[edge.a].push_back(edge.b);
            neighbors[edge.b].push_back(edge.a);
        }
    for (std::size_t i = 0; i < frozen.size(); ++i) {
        const auto [from, motion, rank] = frozen[i];
        for (const VertexId n : neighbors[from]) {
            if (front.is_frozen(n) || !recognizer.is_passed_over(n, motion)) continue;
            front.put_on(n, false, lengths.at(n), rank);
            front.freeze(n);
            frozen.push_back({n, motion, rank});
        }
    }
}

}  // namespace incise::cutting
