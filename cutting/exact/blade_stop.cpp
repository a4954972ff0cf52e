// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/blade_stop.h"

#include <array>
#include <cmath>
#include <set>

#include "incise/cutting/exact/edge_intersections.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// The nodes of the front within this many edge lengths of the blade's edge show whether the cut is
/// behind the blade. If the blade's motion has made the cut, not that of the tissue, the mean
/// cosine of the nodes' directions with the direction backward is above the second number.
constexpr double size_of_neighbourhood = 3.0, least_share_behind = 0.3;

/// How much farther than to the end of a cell a blade is taken to go on, in units of the cell's
/// size. If it went to just that end, rounding or the shift of exact signs would decide.
constexpr double room_ahead = 1e-3;

/// A point of a section along the blade's path: how far it is ahead of the edge, and along it, m.
struct SectionPoint {
    double ahead, along;
};

/// Returns the area of the part of a convex polygon that is ahead of the edge, m2.
/// @param side  1.0; -1.0 for the part behind
double area_ahead(std::span<const SectionPoint> polygon, double side) {
    std::vector<SectionPoint> part;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const SectionPoint a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if (side * a.ahead >= 0.0) part.push_back(a);
        if ((a.ahead < 0.0) == (b.ahead < 0.0)) continue;
        const double share = a.ahead / (a.ahead - b.ahead);
        part.push_back({0.0, a.along + share * (b.along - a.along)});
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < part.size(); ++i) {
        const SectionPoint a = part[i], b = part[(i + 1) % part.size()];
        sum += a.ahead * b.along - b.ahead * a.along;
    }
    return 0.5 * std::abs(sum);
}

/// Brings points of a convex polygon into their order round it.
void sort_round_middle(std::vector<SectionPoint>& points) {
    SectionPoint middle{0.0, 0.0};
    for (const SectionPoint& x : points) {
        middle.ahead += x.ahead / static_cast<double>(points.size());
        middle.along += x.along / static_cast<double>(points.size());
    }
    std::ranges::sort(points, {}, [&](const SectionPoint& x) {
        return std::atan2(x.along - middle.along, x.ahead - middle.ahead);
    });
}

}  // namespace

BladeEnd away_from_cut(const BladeEnd& blade, std::span<const FrontNode> nodes) {
    Vec3 from_cut = Vec3::Zero();
    double share_behind = 0.0, count = 0.0;
    for (const auto& [x, local_edge_length] : nodes) {
        const Vec3 away = blade.away_from_edge(x);
        const double distance = away.norm();
        if (!(distance > 0.0 && distance < size_of_neighbourhood * local_edge_length)) continue;
        from_cut -= away / distance;
        share_behind -= blade.distance_ahead(x) / distance;
        ++count;
    }
    if (count == 0.0 || share_behind > least_share_behind * count) return blade;
    return {blade.edge(), std::vector<Vec3>(blade.edge().size(), from_cut / count)};
}

BladePlace place_of(const BladeEnd& blade, const TissueMotion& tissue,
                    const fragments::FragmentMesh& fragments) {
    const Mesh& mesh = tissue.mesh;
    const auto carrier_of = [&](CellId e) { return fragments.carrier_of_cell(e); };
    const SweptEdge edge(blade.edge(), blade.edge());
    const auto at = [&](VertexId n) -> MovingPoint {
        return {tissue.after[n.index()], tissue.after[n.index()]};
    };
    const auto has_edge = [&](CellId e) {
        for (int f = 0; f < mesh.num_faces(e); ++f)
            for (int p = 2; p < mesh.face_size({e, f}); ++p)
                if (*edge.ends_inside({at(mesh.face_corner({e, f}, 0)),
                                       at(mesh.face_corner({e, f}, p - 1)),
                                       at(mesh.face_corner({e, f}, p))}))
                    return true;
        return false;
    };
    BladePlace place;
    std::set<CellId> known;
    tissue.for_each_near([&](const Box& box) { return edge.may_meet(box); },
                         [&](CellId e) {
                             if (known.contains(e) || !has_edge(e)) return;
                             std::vector<CellId> part = part_of_carrier(mesh, e, carrier_of);
                             std::ranges::sort(part);
                             known.insert(part.begin(), part.end());
                             place.parts.push_back(std::move(part));
                         });
    for (const auto& part : place.parts) {
        // The edge may be in the hindmost face of the part, or in the foremost.
        double more = 0.0;
        for (const CellId e : part)
            more = std::max(more, room_ahead * tissue.box(e).diagonal().norm());
        for (const CellId e : part)
            for (const VertexId n : mesh.corners(e))
                place.exit_distance =
                    std::max(place.exit_distance,
                             more + std::max(0.0, blade.distance_ahead(tissue.after[n.index()])));
    }
    return place;
}

std::unordered_set<CellId> cells_to_part(const BladeEnd& blade, const BladePlace& place,
                                         const Mesh& mesh, std::span<const Vec3> positions,
                                         const LoopFront& front) {
    const SweptEdge continuation = blade.continuation(place.exit_distance);
    const Vec3 along = (blade.edge().back() - blade.edge().front()).stableNormalized();
    const auto in_section = [&](const Vec3& x) -> SectionPoint {
        return {blade.distance_ahead(x), along.dot(x)};
    };
    const auto at = [&](VertexId n) -> MovingPoint {
        return {positions[n.index()], positions[n.index()]};
    };
    std::unordered_set<CellId> chosen;
    for (const auto& part : place.parts) {
        double behind = 0.0, ahead = 0.0;
        for (const CellId e : part) {
            std::vector<SectionPoint> section;
            for (const VertexId n : mesh.corners(e))
                if (front.is_on(n)) section.push_back(in_section(positions[n.index()]));
            for (int f = 0; f < mesh.num_faces(e); ++f)
                for (int p = 0; p < mesh.face_size({e, f}); ++p) {
                    const topology::Dart d{{e, f}, p};
                    const VertexId a = from(mesh, d), b = to(mesh, d);
                    if (b < a) continue;
                    for (const EdgeIntersection& x :
                         intersections_of(continuation, at(a), at(b), 0.0))
                        section.push_back(in_section(x.point));
                }
            if (section.size() < 3) continue;
            sort_round_middle(section);
            behind += area_ahead(section, -1.0);
            ahead += area_ahead(section, 1.0);
        }
        constexpr double rounding = 1e-9;
        if (behind > 0.0 && behind >= (1.0 - rounding) * ahead)
            chosen.insert(part.begin(), part.end());
    }
    return chosen;
}

}  // namespace incise::cutting
