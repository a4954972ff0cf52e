// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/joined_quads.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace incise::topology {

namespace {

/// A triangle with its points in ascending order, for the search.
struct Triangle {
    std::array<std::int64_t, 3> points;
    SourceFace face;
    auto operator<=>(const Triangle&) const = default;
};

std::array<std::int64_t, 3> sorted(std::array<std::int64_t, 3> points) {
    std::ranges::sort(points);
    return points;
}

/// Finds a triangle by points that run anticlockwise as seen from inside its cell.
class Triangles {
  public:
    Triangles(const SourceFaces& faces, std::span<const SourceFace> boundary) : faces_(faces) {
        for (const SourceFace f : boundary)
            if (faces.size(f) == 3) all_.push_back({sorted(points_of(f)), f});
        std::ranges::sort(all_);
    }
    bool is_empty() const { return all_.empty(); }
    const SourceFace* find(const std::array<std::int64_t, 3>& seen_from_inside) const {
        const auto key = sorted(seen_from_inside);
        for (auto it = std::ranges::lower_bound(all_, key, {}, &Triangle::points);
             it != all_.end() && it->points == key; ++it)
            if (runs_against(points_of(it->face), seen_from_inside)) return &it->face;
        return nullptr;
    }

  private:
    std::array<std::int64_t, 3> points_of(SourceFace f) const {
        std::array<std::int64_t, 3> points;
        for (int p = 0; p < 3; ++p) points[static_cast<std::size_t>(p)] = faces_.point(f, p);
        return points;
    }
    static bool runs_against(std::array<std::int64_t, 3> a, const std::array<std::int64_t, 3>& b) {
        std::ranges::rotate(a, std::ranges::find(a, b[0]));
        return a[1] == b[2] && a[2] == b[1];
    }

    const SourceFaces& faces_;
    std::vector<Triangle> all_;
};

std::string plurals(const std::set<CellKind>& kinds) {
    std::string text;
    for (const CellKind kind : kinds)
        text += (text.empty() ? "" : " or ") + std::string(traits(kind).plural);
    return text;
}

}  // namespace

std::vector<JoinedQuad> find_joined_quads(const MeshData& data, const SourceFaces& faces,
                                          std::span<const SourceFace> boundary) {
    std::vector<JoinedQuad> found;
    const auto is_quad = [&](SourceFace f) {
        return data.kinds[f.cell] != CellKind::polyhedron && faces.size(f) == 4;
    };
    if (std::ranges::none_of(boundary, is_quad)) return found;
    const Triangles triangles(faces, boundary);
    if (triangles.is_empty()) return found;
    std::map<SourceFace, int> uses;  // of triangles
    for (const SourceFace f : boundary) {
        if (!is_quad(f)) continue;
        std::vector<JoinedQuad> on_diagonals;
        for (const int k : {0, 1}) {
            const auto at = [&](int p) { return faces.point(f, (k + p) % 4); };
            const SourceFace* const one = triangles.find({at(0), at(1), at(2)});
            const SourceFace* const two = one ? triangles.find({at(2), at(3), at(0)}) : nullptr;
            if (two) on_diagonals.push_back({f, k, {*one, *two}});
        }
        if (on_diagonals.size() != 1) continue;
        found.push_back(on_diagonals.front());
        for (const SourceFace t : found.back().triangles) ++uses[t];
    }
    // A triangle that lies on two quadrilaterals belongs to none.
    std::erase_if(found, [&](const JoinedQuad& joined) {
        return std::ranges::any_of(joined.triangles, [&](SourceFace t) { return uses[t] > 1; });
    });
    std::ranges::sort(found, {}, &JoinedQuad::quad);
    return found;
}

std::vector<Diagonals> diagonals_of_cells(const MeshData& data,
                                          std::span<const JoinedQuad> joined) {
    std::vector<Diagonals> all;
    if (!joined.empty()) all.resize(data.num_cells());
    for (const JoinedQuad& one : joined) all[one.quad.cell].divide(one.quad.face, one.first_end);
    return all;
}

std::vector<std::string> report_of_joins(const MeshData& data, std::span<const JoinedQuad> joined) {
    using Sides = std::tuple<CellKind, std::set<CellKind>, int, std::set<int>>;
    std::map<Sides, std::size_t> counts;
    const bool has_regions =
        std::ranges::adjacent_find(data.regions, std::not_equal_to<>()) != data.regions.end();
    for (const JoinedQuad& one : joined) {
        Sides sides{data.kinds[one.quad.cell], {}, data.regions[one.quad.cell], {}};
        for (const SourceFace t : one.triangles) {
            std::get<1>(sides).insert(data.kinds[t.cell]);
            std::get<3>(sides).insert(data.regions[t.cell]);
        }
        ++counts[sides];
    }
    std::vector<std::string> lines;
    for (const auto& [sides, count] : counts) {
        const auto& [kind, others, region, regions_beyond] = sides;
        std::string line = "joined " + std::to_string(count) +
                           (count == 1 ? " quadrilateral of " : " quadrilaterals of ") +
                           traits(kind).plural + " to two triangles of " + plurals(others) +
                           (count == 1 ? "" : " each");
        if (has_regions) {
            line += ", region " + std::to_string(region) + " to ";
            std::string text;
            for (const int beyond : regions_beyond)
                text += (text.empty() ? "" : " and ") + std::to_string(beyond);
            line += text;
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace incise::topology
