// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/weld_outlook.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>

#include "incise/topology/mesh_repair.h"

namespace incise::topology {

namespace {

/// Returns the result of check() without the search for points at one position.
MeshCheck check_cells(MeshData data) {
    data.points_may_coincide = true;
    return check(data);
}

std::vector<std::size_t> points_of(const SourceFaces& faces, SourceFace f) {
    const std::vector<std::int64_t> numbers = faces.points(f);
    return {numbers.begin(), numbers.end()};
}

/// Returns the faces that belong to only one cell, in ascending order.
std::vector<SourceFace> boundary_of(const MeshData& data, const SourceFaces& faces,
                                    const MeshCheck& checked) {
    std::vector<SourceFace> all, inner, boundary;
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (int f = 0; f < faces.num_faces(c); ++f) all.push_back({c, f});
    for (const SharedFace& shared : checked.shared_faces)
        inner.insert(inner.end(), {shared.a, shared.b});
    for (const JoinedQuad& joined : checked.joined_quads)
        inner.insert(inner.end(), {joined.quad, joined.triangles[0], joined.triangles[1]});
    std::ranges::sort(inner);
    std::ranges::set_difference(all, inner, std::back_inserter(boundary));
    return boundary;
}

}  // namespace

std::optional<UnlikeFaces> find_unlike_faces(const MeshData& data, const MeshCheck& checked) {
    const SourceFaces faces(data);
    auto boundary = boundary_of(data, faces, checked);
    std::erase_if(boundary, [&](SourceFace f) { return data.is_on_cut(f.cell, f.face); });
    std::map<std::array<std::size_t, 3>, std::size_t> face_of_corners;  // index in `boundary`
    for (std::size_t i = 0; i < boundary.size(); ++i) {
        auto points = points_of(faces, boundary[i]);
        if (points.size() != 4) continue;
        std::ranges::sort(points);
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            std::array<std::size_t, 3> three{};
            for (std::size_t k = 0; k < 3; ++k) three[k] = points[k < left_out ? k : k + 1];
            face_of_corners.emplace(three, i);
        }
    }
    std::map<std::size_t, std::vector<std::size_t>> triangles_on;  // cells by index in `boundary`
    for (const SourceFace f : boundary) {
        auto points = points_of(faces, f);
        if (points.size() != 3) continue;
        std::ranges::sort(points);
        const auto found = face_of_corners.find({points[0], points[1], points[2]});
        if (found != face_of_corners.end()) triangles_on[found->second].push_back(f.cell);
    }
    if (triangles_on.empty()) return std::nullopt;
    auto& [face, cells] = *triangles_on.begin();
    return UnlikeFaces{boundary[face].cell, std::move(cells)};
}

std::string name_of(const UnlikeFaces& faces, const MeshData& data) {
    const std::size_t count = faces.of_triangles.size();
    std::string text = "the quadrilateral of " + data.cell_name(faces.cell) +
                       (count == 1 ? " and the triangle of " : " and the triangles of ");
    for (std::size_t k = 0; k < count; ++k)
        text += (k == 0           ? ""
                 : k + 1 == count ? " and "
                                  : ", ") +
                data.cell_name(faces.of_triangles[k]);
    return text + " on it";
}

WeldOutlook outlook_of_weld(const MeshData& data) {
    WeldOutlook outlook;
    MeshData welded = data;
    outlook.num_joined = weld(welded);
    const MeshCheck before = check_cells(data), after = check_cells(welded);
    if (!before.errors.empty()) return outlook;
    if (!after.errors.empty()) {
        outlook.error = after.errors.front();
        return outlook;
    }
    std::vector<SharedFace> gained;
    std::ranges::set_difference(after.shared_faces, before.shared_faces, std::back_inserter(gained),
                                {}, &SharedFace::a, &SharedFace::a);
    std::vector<bool> hangs_together(data.points.size(), false);
    const SourceFaces faces(welded);
    const auto join = [&](SourceFace f) {
        for (const std::size_t p : points_of(faces, f)) hangs_together[p] = true;
    };
    for (const SharedFace& shared : gained) join(shared.a);
    for (const JoinedQuad& joined : after.joined_quads)
        if (!std::ranges::binary_search(before.joined_quads, joined.quad, {}, &JoinedQuad::quad))
            join(joined.quad);
    for (std::size_t p = 0; p < data.points.size(); ++p)
        if (welded.is_welded(p) && !hangs_together[static_cast<std::size_t>(welded.welded_to[p])])
            ++outlook.num_idle;
    if (outlook.num_idle > 0) outlook.unlike_faces = find_unlike_faces(welded, after);
    return outlook;
}

std::vector<bool> points_of_boundary(const MeshData& data) {
    std::vector<bool> is_on_boundary(data.points.size(), false);
    const SourceFaces faces(data);
    for (const SourceFace f : boundary_of(data, faces, check_cells(data)))
        for (const std::size_t p : points_of(faces, f)) is_on_boundary[p] = true;
    return is_on_boundary;
}

}  // namespace incise::topology
