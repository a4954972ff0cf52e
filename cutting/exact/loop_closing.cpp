// How a cut goes through a cell where its path on the faces of the cell is closed.
// Source: docs/cutting.md, Cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>

#include "incise/cutting/exact/loop_step.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Dart;

/// Goes round a node of a cell, from an edge that comes to it, to the next place where the cut is:
/// an open edge, or a face in which the node waits. Returns the other end of the edge; an invalid
/// id at a face, and if there is only the edge from which it starts.
/// @param arriving  the dart to the node
/// @param is_left   true to turn to the faces on the left of the dart first
VertexId LoopStep::turn(const LoopFront& front, Dart arriving, bool is_left) const {
    const VertexId n = to(mesh_, arriving), start = from(mesh_, arriving);
    const std::vector<Edge>& open = front.open_edges(arriving.face.cell);
    Dart side = is_left ? arriving : opposite(mesh_, arriving);  // in a face at the node
    for (int left = mesh_.num_faces(side.face.cell); left > 0; --left) {
        const Dart leaving = is_left ? next(mesh_, side) : previous(mesh_, side);
        const VertexId end = is_left ? to(mesh_, leaving) : from(mesh_, leaving);
        if (front.waits(side.face, n) || end == start) return {};
        if (std::ranges::find(open, edge_between(n, end)) != open.end()) return end;
        side = opposite(mesh_, leaving);
    }
    return {};
}

/// Returns a closed path of open edges of a cell, which an edge from v to w has completed; empty if
/// there is none. At a node with several ways the path turns to the next edge, so that it does not
/// part what belongs together.
std::vector<VertexId> LoopStep::path_from(const LoopFront& front, CellId e, VertexId v,
                                          VertexId w) const {
    const std::vector<Edge>& open = front.open_edges(e);
    const auto num_ways = [&](VertexId n) {
        return std::ranges::count_if(open, [&](const Edge& x) { return x.a == n || x.b == n; }) - 1;
    };
    for (const bool is_left : {true, false}) {
        std::vector<VertexId> path{v, w};
        for (;;) {
            const VertexId before = path[path.size() - 2], n = path.back();
            VertexId end;
            if (num_ways(n) == 1) {
                for (const Edge& x : open)
                    if (x.a == n ? x.b != before : x.b == n && x.a != before)
                        end = x.a == n ? x.b : x.a;
            } else {
                const Dart arriving = find_dart(mesh_, e, before, n);
                end = turn(front, arriving, is_left);
                if (!end.is_valid()) end = turn(front, arriving, !is_left);
            }
            if (!end.is_valid()) break;
            const auto first = std::ranges::find(path, end);
            if (first == path.end()) {
                path.push_back(end);
                continue;
            }
            path.erase(path.begin(), first);
            if (path.size() > 2 &&
                (num_ways(end) == 1 || parts_evenly(front, e, path.back(), path[0], path[1])))
                return path;
            break;
        }
    }
    return {};
}

/// True if a path in a cell leaves an even number of places where the cut is on each side of a
/// node: open edges, and faces in which the node waits.
bool LoopStep::parts_evenly(const LoopFront& front, CellId e, VertexId from_node, VertexId n,
                            VertexId to_node) const {
    const std::vector<Edge>& open = front.open_edges(e);
    bool is_even = true;
    Dart side = find_dart(mesh_, e, from_node, n);
    for (int left = mesh_.num_faces(e); left > 0; --left) {
        if (front.waits(side.face, n)) is_even = !is_even;
        const Dart leaving = next(mesh_, side);
        const VertexId end = to(mesh_, leaving);
        if (end == to_node || end == from_node) return is_even;
        if (std::ranges::find(open, edge_between(n, end)) != open.end()) is_even = !is_even;
        side = opposite(mesh_, leaving);
    }
    return false;
}

/// Returns the faces of a cell on one side of a closed path of its edges.
std::vector<FaceId> LoopStep::faces_beside(CellId e, std::span<const VertexId> path,
                                           bool is_left) const {
    const Dart first = find_dart(mesh_, e, path[0], path[1]);
    std::vector<FaceId> faces{is_left ? first.face : opposite(mesh_, first).face};
    std::vector<Edge> border;
    for (std::size_t i = 0; i < path.size(); ++i)
        border.push_back(edge_between(path[i], path[(i + 1) % path.size()]));
    for (std::size_t i = 0; i < faces.size(); ++i)  // more are added
        for (int p = 0; p < mesh_.face_size(faces[i]); ++p) {
            const Dart d{faces[i], p};
            if (std::ranges::find(border, edge_between(from(mesh_, d), to(mesh_, d))) !=
                border.end())
                continue;
            const FaceId next = opposite(mesh_, d).face;
            if (std::ranges::find(faces, next) == faces.end()) faces.push_back(next);
        }
    return faces;
}

/// True if the middle of a face, and the middles of its edges, lie on a surface at once, to the
/// tolerance.
bool LoopStep::lies_on_surface(FaceId f) const {
    const int size = mesh_.face_size(f);
    Vec3 middle = Vec3::Zero();
    double longest = 0.0;
    std::vector<Vec3> points;
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(f, p), next = mesh_.face_corner(f, (p + 1) % size);
        middle += point(n)[1] / size;
        points.emplace_back(0.5 * (point(n)[1] + point(next)[1]));
        longest = std::max(longest, (point(next)[1] - point(n)[1]).norm());
    }
    points.push_back(middle);
    return std::ranges::all_of(points, [&](const Vec3& x) {
        return surface_.comes_within(x, 2.0 * nearness_of_nodes_ * longest);
    });
}

/// Returns the faces of a cell on that side of a closed path on which there is almost nothing
/// between them and a face along the path; none if both sides have a volume.
std::vector<FaceId> LoopStep::faces_within(CellId e, std::span<const VertexId> path) const {
    // Thickness, as a share of the width.
    const double flat = (2.0 / 3.0) * std::min(nearness_of_nodes_, 0.5 * default_snap);
    const Vec3& origin = mesh_.rest_position(path[0]);
    Vec3 area = Vec3::Zero();
    for (std::size_t i = 2; i < path.size(); ++i)
        area += 0.5 * (mesh_.rest_position(path[i - 1]) - origin)
                          .cross(mesh_.rest_position(path[i]) - origin);
    std::vector<FaceId> found;
    double least = flat * std::pow(area.norm(), 1.5);
    bool found_lies_on = false;  // on a surface at once: then the thickness is nothing
    for (const bool is_left : {true, false}) {
        std::vector<FaceId> faces = faces_beside(e, path, is_left);
        if (faces.size() == 1) return faces;
        double volume = 0.0;
        for (const FaceId f : faces)
            for (int p = 2; p < mesh_.face_size(f); ++p) {
                const auto at = [&](int q) -> Vec3 {
                    return mesh_.rest_position(mesh_.face_corner(f, q)) - origin;
                };
                volume += at(0).cross(at(p - 1)).dot(at(p)) / 6.0;
            }
        const bool lies_on =
            !is_swept_ && std::ranges::all_of(faces, [&](FaceId f) { return lies_on_surface(f); });
        if (lies_on < found_lies_on || (lies_on == found_lies_on && std::abs(volume) >= least))
            continue;
        least = std::abs(volume);
        found_lies_on = lies_on;
        found = std::move(faces);
    }
    return found;
}

/// Takes a cut through a cell if the edge completes a closed path: along faces of the cell, or
/// along a new one that divides it.
void LoopStep::close(LoopFront& front, CellId e, VertexId v, VertexId w) {
    if (!front.is_open(e, v, w)) return;
    if (&front == &front_ && stays_whole(e)) return;
    const std::vector<VertexId> path = path_from(front, e, v, w);
    if (path.empty()) return;
    std::array<CellId, 2> parts{e, {}};
    if (const std::vector<FaceId> faces = faces_within(e, path); !faces.empty())
        close_along(front, faces, front.local_edge_length(v));
    else
        parts[1] = divide_cell(front, e, path);
    for (const CellId part : parts)
        for (std::size_t i = 0; i < path.size(); ++i)
            front.set_closed(part, path[i], path[(i + 1) % path.size()]);
    if (parts[1].is_valid()) {
        const FaceId made{parts[1], mesh_.num_faces(parts[1]) - 1};
        for_cuts(nullptr, [&](const Cut& cut) { make_wait_in(cut.front, made, path); });
        for_cuts(&front, [&](const Cut& cut) {
            if (cut.resting != nullptr || is_swept_)
                for (const VertexId n : path) join_at(cut.front, n);
        });
    }
    // The path can be another one, which touches that of the edge.
    for (const CellId part : parts)
        if (part.is_valid() && find_dart(mesh_, part, v, w).is_valid()) close(front, part, v, w);
}

/// Divides a cell along a closed path of a cut. Returns the new part.
CellId LoopStep::divide_cell(LoopFront& front, CellId e, std::span<const VertexId> path) {
    std::vector<std::vector<VertexId>> before;
    for (int k = 0; k < mesh_.num_faces(e); ++k) {
        before.emplace_back();
        for (int p = 0; p < mesh_.face_size({e, k}); ++p)
            before.back().push_back(mesh_.face_corner({e, k}, p));
    }
    const CellId added = edit_->divide_cell(e, path);
    std::vector<FaceId> faces;  // in each part they are in the order that they had
    FaceId left{e, 0}, right{added, 0};
    for (const std::vector<VertexId>& corners : before) {
        bool is_left = mesh_.face_size(left) == static_cast<int>(corners.size());
        for (int p = 0; is_left && p < mesh_.face_size(left); ++p)
            is_left = mesh_.face_corner(left, p) == corners[static_cast<std::size_t>(p)];
        FaceId& face = is_left ? left : right;
        faces.push_back(face);
        ++face.face;
    }
    if (only_ && !stays_whole(e)) only_->insert(added);
    divided_.insert(divided_.end(), {e, added});
    for (auto& [n, begins] : rings_)
        for (CellId& begin : begins)
            if (begin == e && mesh_.corner_of(e, n) < 0) begin = added;
    for_cuts(nullptr, [&](const Cut& cut) { cut.front.divide(mesh_, e, added, faces); });
    front.set_on_cut(mesh_, {added, mesh_.num_faces(added) - 1}, true, false);
    return added;
}

/// Takes a cut along faces of a cell. A face along which it goes from both sides is not on it.
void LoopStep::close_along(LoopFront& front, std::span<const FaceId> faces,
                           double local_edge_length) {
    for (const FaceId f : faces) {
        for (int p = 0; p < mesh_.face_size(f); ++p) {
            const Dart d{f, p};
            const VertexId a = from(mesh_, d), b = to(mesh_, d);
            if (!front.lies_on(a, b)) front.set_along(a, b);
            front.put_through(a, local_edge_length);
        }
        if (mesh_.neighbor(f).is_valid()) front.set_on_cut(mesh_, f, !front.is_cut_face(f), true);
        divided_.push_back(f.cell);
    }
}

/// Divides the cells that were to stay whole, but that the cut has come all round.
void LoopStep::close_all() {
    only_.reset();
    const auto num_open = [&] {
        std::size_t count = 0;
        for (const CellId e : front_.open_cells()) count += front_.open_edges(e).size();
        return count;
    };
    for (std::size_t before = 0; before != num_open();) {
        before = num_open();  // a part can have another closed path
        for (const CellId e : front_.open_cells())
            for (const Edge& edge : std::vector(front_.open_edges(e)))
                close(front_, e, edge.a, edge.b);
    }
}

}  // namespace incise::cutting
