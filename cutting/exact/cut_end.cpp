// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/cut_end.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <set>

#include "incise/cutting/exact/blade_stop.h"

namespace incise::cutting {

using topology::Mesh;

namespace {

/// The precision of intersections with the blade's edge, as a share of the edge of the mesh.
constexpr double rounding_of_places = 1e-9;
constexpr int max_bisections = 50;

/// Returns the area of one side of the faces inside a part of a carrier that are open, at rest, m2.
double opened_area(const Mesh& mesh, std::span<const CellId> part) {
    using Triangle = std::array<Vec3, 3>;
    std::vector<Triangle> open;  // with its corners in a fixed order
    double area = 0.0;
    const auto is_before = [](const Vec3& a, const Vec3& b) {
        return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
    };
    for (const CellId e : part)
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            if (mesh.neighbor({e, f}).is_valid()) continue;
            Triangle x;
            for (int p = 0; p < 3; ++p)
                x[static_cast<std::size_t>(p)] = mesh.rest_position(mesh.face_corner({e, f}, p));
            std::ranges::sort(x, is_before);
            const auto other = std::ranges::find(open, x);
            if (other == open.end()) {
                open.push_back(x);
                continue;
            }
            open.erase(other);
            area += topology::rest_area(mesh, {e, f});
        }
    return area;
}

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
    std::set<std::pair<VertexId, VertexId>> known;
    for (const FaceId f : faces)
        for (int p = 0; p < 3; ++p) {
            const Edge edge =
                edge_between(mesh_.face_corner(f, p), mesh_.face_corner(f, (p + 1) % 3));
            if (!known.insert({edge.a, edge.b}).second) continue;
            if (const auto there = intersection(edge)) crossed.push_back({edge, f.cell, *there});
        }
    for (const auto& [edge, element, intersection] : crossed)
        if (std::min(intersection.place, 1.0 - intersection.place) < share)
            put_at(nearer_end(edge, intersection));
    return crossed;
}

/// True if no part of a face on the cut is ahead of the blade's edge.
bool CutEnd::is_behind(FaceId f) const {
    int num_at = 0;
    double sum = 0.0;
    for (int p = 0; p < 3; ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        const double ahead = distance_ahead(n);
        sum += ahead;
        if (is_at(n))
            ++num_at;
        else if (ahead > 0.0)
            return false;
    }
    return num_at < 3 || sum <= 0.0;
}

/// True if a face is ahead of the edge, at least in part, and inside a carrier.
bool CutEnd::is_ahead_inside(FaceId f) const {
    return !is_behind(f) && carrier_of(f.cell) == carrier_of(mesh_.neighbor(f).cell);
}

std::vector<FaceId> CutEnd::faces_to_open(std::span<const FaceId> faces) const {
    struct Section {
        double behind, ahead;  // area on either side of the edge, at rest, m2
    };
    std::vector<Section> sections;                       // of parts of carriers with the edge
    std::unordered_map<CellId, std::size_t> section_of;  // by element of such a part
    for (const FaceId f : faces) {
        if (section_of.contains(f.cell) || !is_ahead_inside(f)) continue;
        const auto part = part_of_carrier(mesh_, f.cell, [&](CellId e) { return carrier_of(e); });
        for (const CellId e : part) section_of[e] = sections.size();
        sections.push_back({opened_area(mesh_, part), 0.0});
    }
    const auto section_with = [&](FaceId f) -> Section* {
        const auto a = section_of.find(f.cell), b = section_of.find(mesh_.neighbor(f).cell);
        const bool is_inside =
            a != section_of.end() && b != section_of.end() && a->second == b->second;
        return is_inside ? &sections[a->second] : nullptr;
    };
    for (const FaceId f : faces)
        if (Section* section = section_with(f))
            (is_behind(f) ? section->behind : section->ahead) += topology::rest_area(mesh_, f);
    std::vector<FaceId> chosen;
    std::ranges::copy_if(faces, std::back_inserter(chosen), [&](FaceId f) {
        if (is_behind(f)) return true;
        const Section* section = section_with(f);
        return section && section->behind >= (1.0 - rounding_of_places) * section->ahead;
    });
    return chosen;
}

}  // namespace incise::cutting
