// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/cut_end.h"

#include <algorithm>
#include <set>

namespace incise::cutting {

namespace {

/// The precision of intersections with the blade's edge, as a share of the edge of the mesh.
constexpr double rounding_of_places = 1e-9;
constexpr int max_bisections = 50;

/// The nodes of the front within this many edge lengths of the blade's edge show whether the cut is
/// behind the blade. If the blade's motion has made the cut, not that of the tissue, the mean
/// cosine of the nodes' directions with the direction backward is above the second number.
constexpr double size_of_neighbourhood = 3.0, least_share_behind = 0.3;

/// How much farther than to the end of an element a blade is taken to go on, in units of the
/// element's size. If it went to just that end, rounding or the shift of exact signs would decide.
constexpr double room_ahead = 1e-3;

}  // namespace

std::optional<EdgeIntersection> CutEnd::intersection(const Edge& edge) const {
    const double a = distance_ahead(edge.a), b = distance_ahead(edge.b);
    if (!(a < 0.0 && b > 0.0) && !(a > 0.0 && b < 0.0)) return std::nullopt;
    const Vec3 from = position_(edge.a), to = position_(edge.b);
    const auto at = [&](double place) -> Vec3 { return (1.0 - place) * from + place * to; };
    const double length = (to - from).norm();
    double place = a / (a - b);  // exact if the blade's edge is straight
    double low = 0.0, high = 1.0;
    for (int i = 0; i < max_bisections; ++i) {
        const double ahead = blade_.distance_ahead(at(place));
        if (std::abs(ahead) <= rounding_of_places * length) break;
        ((ahead < 0.0) == (a < 0.0) ? low : high) = place;
        place = 0.5 * (low + high);
    }
    return EdgeIntersection{place, 1.0, at(place), Vec3::Zero()};
}

std::vector<CutEnd::CrossedEdge> CutEnd::crossed_edges(std::span<const FaceId> faces,
                                                       double share) {
    std::vector<CrossedEdge> crossed;
    std::set<std::pair<NodeId, NodeId>> known;
    for (const FaceId f : faces)
        for (int p = 0; p < 3; ++p) {
            const Edge edge =
                edge_between(mesh_.face_corner(f, p), mesh_.face_corner(f, (p + 1) % 3));
            if (!known.insert({edge.a, edge.b}).second) continue;
            if (const auto there = intersection(edge)) crossed.push_back({edge, f.element, *there});
        }
    for (const auto& [edge, element, intersection] : crossed)
        if (std::min(intersection.place, 1.0 - intersection.place) < share)
            put_at(nearer_end(edge, intersection));
    return crossed;
}

bool CutEnd::is_behind(FaceId f) const {
    int num_at = 0;
    double sum = 0.0;
    for (int p = 0; p < 3; ++p) {
        const NodeId n = mesh_.face_corner(f, p);
        const double ahead = distance_ahead(n);
        sum += ahead;
        if (is_at(n))
            ++num_at;
        else if (ahead > 0.0)
            return false;
    }
    return num_at < 3 || sum <= 0.0;
}

BladeEnd away_from_cut(const BladeEnd& blade, const topology::Mesh& mesh, const CutFront& front,
                       const PositionOf& position) {
    // Sorted, so that the sums do not depend on the history of the front.
    std::vector<NodeId> nodes;
    front.for_each([&](NodeId n) {
        if (mesh.is_alive(n)) nodes.push_back(n);
    });
    std::sort(nodes.begin(), nodes.end());
    Vec3 from_cut = Vec3::Zero();
    double share_behind = 0.0, count = 0.0;
    for (const NodeId n : nodes) {
        const Vec3 away = blade.away_from_edge(position(n));
        const double distance = away.norm();
        if (!(distance > 0.0 && distance < size_of_neighbourhood * front.local_edge_length(n)))
            continue;
        from_cut -= away / distance;
        share_behind -= blade.distance_ahead(position(n)) / distance;
        ++count;
    }
    if (count == 0.0 || share_behind > least_share_behind * count) return blade;
    return {blade.edge(), std::vector<Vec3>(blade.edge().size(), from_cut / count)};
}

double exit_distance(const TissueMotion& tissue, const BladeEnd& blade) {
    const SweptEdge edge(blade.edge(), blade.edge());
    double farthest = 0.0;
    tissue.for_each_near(
        [&](const Box& box) { return edge.may_meet(box); },
        [&](ElementId e) {
            const topology::Mesh& mesh = tissue.mesh;
            if (mesh.kind(e) != topology::CellKind::tetrahedron) return;
            bool has_edge = false;
            for (int f = 0; f < 4 && !has_edge; ++f) {
                std::array<MovingPoint, 3> points;
                for (int p = 0; p < 3; ++p) {
                    const Vec3& x = tissue.after[mesh.face_corner({e, f}, p).index()];
                    points[static_cast<std::size_t>(p)] = {x, x};
                }
                has_edge = *edge.ends_inside(points);
            }
            if (!has_edge) return;
            // The edge may be in the hindmost face of the element, or in the foremost.
            const double more = room_ahead * tissue.box(e).diagonal().norm();
            for (const NodeId n : mesh.corners(e))
                farthest = std::max(
                    farthest, more + std::max(0.0, blade.distance_ahead(tissue.after[n.index()])));
        });
    return farthest;
}

}  // namespace incise::cutting
