// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/weld_outlook.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>

#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_repair.h"

namespace incise::topology {

namespace {

/// Returns the result of check() without the search for points at one position.
MeshCheck check_cells(MeshData data) {
    data.points_may_coincide = true;
    return check(data);
}

std::vector<std::size_t> points_of(const MeshData& data, SourceFace f) {
    std::vector<std::size_t> points;
    for (const int corner : traits(data.kinds[f.cell]).face(f.face))
        points.push_back(
            static_cast<std::size_t>(data.cell(f.cell)[static_cast<std::size_t>(corner)]));
    return points;
}

/// Returns the faces that belong to only one cell, in ascending order.
std::vector<SourceFace> boundary_of(const MeshData& data, const MeshCheck& checked) {
    std::vector<SourceFace> all, inner, boundary;
    for (std::size_t c = 0; c < data.num_cells(); ++c)
        for (int f = 0; f < traits(data.kinds[c]).num_faces; ++f) all.push_back({c, f});
    for (const SharedFace& shared : checked.shared_faces)
        inner.insert(inner.end(), {shared.a, shared.b});
    std::ranges::sort(inner);
    std::ranges::set_difference(all, inner, std::back_inserter(boundary));
    return boundary;
}

/// Returns two cells, if there are any: the first with a quadrilateral boundary face, the second
/// with a triangular boundary face that has three corners of the quadrilateral.
std::optional<std::pair<std::size_t, std::size_t>> find_unlike_faces(const MeshData& data,
                                                                     const MeshCheck& checked) {
    std::map<std::array<std::size_t, 3>, std::size_t> cell_of_corners;
    const auto boundary = boundary_of(data, checked);
    for (const SourceFace f : boundary) {
        auto points = points_of(data, f);
        if (points.size() != 4) continue;
        std::ranges::sort(points);
        for (std::size_t left_out = 0; left_out < 4; ++left_out) {
            std::array<std::size_t, 3> three{};
            for (std::size_t k = 0; k < 3; ++k) three[k] = points[k < left_out ? k : k + 1];
            cell_of_corners[three] = f.cell;
        }
    }
    for (const SourceFace f : boundary) {
        auto points = points_of(data, f);
        if (points.size() != 3) continue;
        std::ranges::sort(points);
        const auto found = cell_of_corners.find({points[0], points[1], points[2]});
        if (found != cell_of_corners.end()) return std::pair(found->second, f.cell);
    }
    return std::nullopt;
}

}  // namespace

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
    for (const SharedFace& shared : gained)
        for (const std::size_t p : points_of(welded, shared.a)) hangs_together[p] = true;
    for (std::size_t p = 0; p < data.points.size(); ++p)
        if (welded.is_welded(p) && !hangs_together[static_cast<std::size_t>(welded.welded_to[p])])
            ++outlook.num_idle;
    if (outlook.num_idle > 0) outlook.unlike_faces = find_unlike_faces(welded, after);
    return outlook;
}

std::vector<bool> points_of_boundary(const MeshData& data) {
    std::vector<bool> is_on_boundary(data.points.size(), false);
    for (const SourceFace f : boundary_of(data, check_cells(data)))
        for (const std::size_t p : points_of(data, f)) is_on_boundary[p] = true;
    return is_on_boundary;
}

}  // namespace incise::topology
