// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/creases.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace incise::cutting {

namespace {

/// Cosine of the smallest angle of a crease, 18 degrees.
constexpr double sharp = 0.95;
/// Branches whose planes are this share of an edge apart are two, even if they are parallel.
constexpr double apart = 0.2;

}  // namespace

bool is_same_branch(std::span<const CutRecord> snap_history, const CutRecord& intersection,
                    double length) {
    return snap_history.empty() || std::ranges::any_of(snap_history, [&](const CutRecord& record) {
               const Vec3 way = intersection.to_surface - record.to_surface;
               return std::abs(record.normal.dot(intersection.normal)) >= sharp &&
                      std::abs(record.normal.dot(way)) < apart * length;
           });
}

bool is_crossed_from_middle(const CutSurface& surface, const std::array<MovingPoint, 4>& corners,
                            const MovingPoint& corner) {
    MovingPoint middle{Vec3::Zero(), Vec3::Zero()};
    for (const MovingPoint& x : corners)
        for (std::size_t k = 0; k < 2; ++k) middle[k] += 0.25 * x[k];
    std::vector<Crossing> crossings;
    surface.append_crossings(middle, corner, crossings);
    return crossings.size() % 2 == 1;
}

NodesOnSurface::NodesOnSurface(const CutSurface& surface, const TissueMotion& tissue,
                               std::span<const EdgeList::Entry> edges, double rounding) {
    if (!surface.has_creases()) return;
    struct End {
        VertexId node;
        double length, length_at_rest;
    };
    std::vector<End> ends;
    for (const EdgeList::Entry& entry : edges) {
        const Edge& edge = entry.edge;
        const auto length = [&](auto position) {
            return (position(edge.b) - position(edge.a)).norm();
        };
        const double now = length([&](VertexId n) { return tissue.after[n.index()]; }),
                     at_rest = length([&](VertexId n) { return tissue.mesh.rest_position(n); });
        for (const VertexId n : {edge.a, edge.b}) ends.push_back({n, now, at_rest});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.node < b.node; });

    for (auto end = ends.begin(); end != ends.end();) {
        End longest = *end;
        for (; end != ends.end() && end->node == longest.node; ++end) {
            longest.length = std::max(longest.length, end->length);
            longest.length_at_rest = std::max(longest.length_at_rest, end->length_at_rest);
        }
        const Vec3& x = tissue.after[longest.node.index()];
        if (const auto normal = surface.normal_near(x, rounding * longest.length))
            nodes_.push_back({longest.node, *normal, longest.length_at_rest});
    }
}

bool NodesOnSurface::contains(VertexId n) const {
    const auto place = std::ranges::lower_bound(nodes_, n, {}, &NodeOnSurface::node);
    return place != nodes_.end() && place->node == n;
}

bool NodesOnSurface::have_face_of(const topology::Mesh& mesh, CellId e) const {
    return mesh.kind(e) == topology::CellKind::tetrahedron &&
           std::ranges::count_if(mesh.corners(e), [&](VertexId n) { return contains(n); }) >= 3;
}

}  // namespace incise::cutting
