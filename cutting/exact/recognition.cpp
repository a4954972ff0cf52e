// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/recognition.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_set>

namespace incise::cutting {

namespace {

class Recognizer {
  public:
    Recognizer(const TissueMotion& tissue, const CutSurface& surface,
               std::span<const EdgeList::Entry> edges, const SnapHistory& snap_history)
        : tissue_(tissue), surface_(surface), snap_history_(snap_history) {
        if (surface.identity() == no_identity) return;
        for (const auto& [edge, element] : edges)
            if (moves(edge.a) || moves(edge.b)) moving_.insert({edge.a, edge.b});
    }

    /// Puts the node on the front if the surface passes by it as one of its records says. `length`
    /// is that of an edge there, m.
    void look_at(NodeId n, double length, CutFront& front) const {
        for (const CutRecord& record : snap_history_.of(n)) {
            const bool may_freeze = is_where_it_was(n, record, length);
            if (front.is_on(n) && !may_freeze) continue;
            const std::optional<Crossing> intersection =
                may_freeze ? intersection_near(n, record, length)
                           : intersection_by(n, record.to_surface, record.normal, length);
            // Another surface through the same point is another cut.
            if (!intersection || !is_along(record, intersection->normal)) continue;
            if (!front.is_on(n)) front.put_on(n, record.is_exact, length, record.rank);
            if (!may_freeze) continue;
            front.freeze(n);
            return;
        }
    }

  private:
    bool moves(NodeId n) const { return tissue_.before[n.index()] != tissue_.after[n.index()]; }

    /// Returns the intersection of the surface with the place at which a cut passed by the node.
    std::optional<Crossing> intersection_by(NodeId n, const Vec3& to_surface, const Vec3& normal,
                                            double length) const {
        const Vec3 short_way = SnapHistory::rounding * length * normal;
        const auto beside = [&](const Vec3& way) -> MovingPoint {
            return {tissue_.before[n.index()] + to_surface + way,
                    tissue_.after[n.index()] + to_surface + way};
        };
        std::vector<Crossing> crossings;
        surface_.append_crossings(beside(-short_way), beside(short_way), crossings);
        return crossings.size() % 2 == 1 ? std::optional(crossings.front()) : std::nullopt;
    }

    /// Returns the intersection at that place or beside it. At a crease of the surface, rounding
    /// may have put the place beyond the crease. Prefers an intersection with the direction of the
    /// earlier cut.
    std::optional<Crossing> intersection_near(NodeId n, const CutRecord& record,
                                              double length) const {
        const Vec3 u = 2.0 * SnapHistory::rounding * length * record.normal.unitOrthogonal();
        const Vec3 v = record.normal.cross(u);
        std::optional<Crossing> other;
        for (const int s : {0, 1, -1})
            for (const int t : {0, 1, -1}) {
                auto intersection =
                    intersection_by(n, record.to_surface + s * u + t * v, record.normal, length);
                if (intersection && is_along(record, intersection->normal)) return intersection;
                if (!other) other = intersection;
            }
        return other;
    }

    /// True if the surface is that of the record and the node is where it was then.
    bool is_where_it_was(NodeId n, const CutRecord& record, double length) const {
        return surface_.identity() != no_identity && record.surface == surface_.identity() &&
               !moving_.contains(n) &&
               (tissue_.after[n.index()] - record.place).norm() <= SnapHistory::rounding * length;
    }
    static bool is_along(const CutRecord& record, const Vec3& normal) {
        return record.normal.cross(normal).norm() < SnapHistory::rounding * normal.norm();
    }

    const TissueMotion& tissue_;
    const CutSurface& surface_;
    const SnapHistory& snap_history_;
    std::unordered_set<NodeId> moving_;  // nodes that move in this step, and their neighbours
};

}  // namespace

void recognize(const TissueMotion& tissue, const CutSurface& surface,
               std::span<const EdgeList::Entry> edges, const SnapHistory& snap_history,
               CutFront& front) {
    if (snap_history.is_empty()) return;
    const auto is_new = [&](NodeId n) { return !snap_history.of(n).empty() && !front.is_on(n); };
    std::vector<Edge> scarred;
    for (const auto& [edge, element] : edges)
        if (is_new(edge.a) || is_new(edge.b)) scarred.push_back(edge);
    if (scarred.empty()) return;
    // Sorted, so that the order does not depend on which elements are near.
    std::sort(scarred.begin(), scarred.end());

    const Recognizer recognizer(tissue, surface, edges, snap_history);
    for (const Edge& edge : scarred)
        for (const NodeId n : {edge.a, edge.b}) {
            if (front.is_on(n)) continue;
            const double length =
                (tissue.mesh.rest_position(edge.b) - tissue.mesh.rest_position(edge.a)).norm();
            recognizer.look_at(n, length, front);
        }
}

}  // namespace incise::cutting
