// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/recognition.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace incise::cutting {

namespace {

class Recognizer {
  public:
    Recognizer(const TissueMotion& tissue, const CutSurface& surface,
               const SnapHistory& snap_history)
        : tissue_(tissue), surface_(surface), snap_history_(snap_history) {}

    /// Puts the node on the front if the surface passes by it as one of its records says. `length`
    /// is that of an edge there, m.
    void look_at(NodeId n, double length, CutFront& front) const {
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
            return;
        }
    }

  private:
    /// Returns the intersection of the surface with the place at which a cut passed by the node.
    std::optional<Crossing> intersection_by(NodeId n, const Vec3& to_surface, const Vec3& normal,
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
    bool is_where_it_was(NodeId n, const CutRecord& record, double length) const {
        constexpr double near = 0.1;  // share of an edge; more may be another part of the tissue
        return surface_.identity() != no_identity && record.surface == surface_.identity() &&
               std::abs(record.normal.dot(tissue_.after[n.index()] - record.place)) <=
                   near * length;
    }
    bool has_stayed(NodeId n, const CutRecord& record, double length) const {
        return (tissue_.after[n.index()] - record.place).norm() <= SnapHistory::rounding * length;
    }
    static bool is_along(const CutRecord& record, const Vec3& normal) {
        return record.normal.cross(normal).norm() < SnapHistory::rounding * normal.norm();
    }

    const TissueMotion& tissue_;
    const CutSurface& surface_;
    const SnapHistory& snap_history_;
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

    const Recognizer recognizer(tissue, surface, snap_history);
    for (const Edge& edge : scarred)
        for (const NodeId n : {edge.a, edge.b}) {
            if (front.is_on(n)) continue;
            const double length =
                (tissue.mesh.rest_position(edge.b) - tissue.mesh.rest_position(edge.a)).norm();
            recognizer.look_at(n, length, front);
        }
}

}  // namespace incise::cutting
