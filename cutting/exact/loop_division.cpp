// How a step of a cut divides edges, faces and cells, and opens faces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cassert>

#include "incise/cutting/exact/loop_step.h"
#include "incise/cutting/exact/triangulation.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Dart;
using topology::Mesh;

/// Divides an edge for all cuts.
VertexId LoopStep::divide_edge(VertexId a, VertexId b, double place) {
    std::vector<CellId> cells;
    append_cells_at_edge(mesh_, mesh_.incident_element(a), a, b, cells);
    assert(!cells.empty());
    divided_.insert(divided_.end(), cells.begin(), cells.end());
    const double length = rest_length(a, b);
    const VertexId middle = edit_->divide_edge(find_dart(mesh_, cells.front(), a, b), place);
    place_new_node(middle, std::array{std::pair(a, 1.0 - place), std::pair(b, place)});
    note_rings(middle, a, cells);
    front_.divide(a, b, middle, length);
    for (SuspendedLoops& blade : resting_) blade.front.divide(a, b, middle, length);
    return middle;
}

/// Where an earlier cut ends, two rings of cells can have an edge between the same two nodes, with
/// opened faces between them. A new node of this edge becomes two at the end of the edit.
void LoopStep::note_rings(VertexId middle, VertexId a, std::span<const CellId> cells) {
    std::vector<CellId> found, begins;
    for (const CellId e : cells) {
        if (std::ranges::find(found, e) != found.end()) continue;
        begins.push_back(e);
        const std::size_t begin = found.size();
        found.push_back(e);
        for (std::size_t i = begin; i < found.size(); ++i)  // more are added
            for (const auto& [x, y] : {std::pair(a, middle), std::pair(middle, a)}) {
                const CellId next = mesh_.neighbor(find_dart(mesh_, found[i], x, y).face).cell;
                if (next.is_valid() && std::ranges::find(found, next) == found.end())
                    found.push_back(next);
            }
    }
    if (begins.size() > 1) rings_[middle] = std::move(begins);
}

/// Returns the cells at a node.
std::vector<CellId> LoopStep::star(VertexId v) const {
    std::vector<CellId> cells;
    topology::collect_star(mesh_, v, mesh_.incident_element(v), cells);
    if (const auto it = rings_.find(v); it != rings_.end())
        for (const CellId e : it->second) {
            if (std::ranges::find(cells, e) != cells.end()) continue;
            std::vector<CellId> more;
            topology::collect_star(mesh_, v, e, more);
            cells.insert(cells.end(), more.begin(), more.end());
        }
    return cells;
}

/// Returns the faces at a node, each by one of its sides.
std::vector<FaceId> LoopStep::faces_at(VertexId v) const {
    std::vector<FaceId> faces;
    for (const CellId e : star(v))
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f}, other = mesh_.neighbor(face);
            if (other.is_valid() && other < face) continue;
            for (int p = 0; p < mesh_.face_size(face); ++p)
                if (mesh_.face_corner(face, p) == v) faces.push_back(face);
        }
    return faces;
}

/// Returns another node that waits in the face.
std::optional<VertexId> LoopStep::waiting_partner(const LoopFront& front, FaceId f,
                                                  VertexId v) const {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        if (const VertexId n = mesh_.face_corner(f, p); n != v && front.waits(mesh_, f, n))
            return n;
    return std::nullopt;
}

/// Joins a node with those that wait for it in the faces at it. In a face that is plane, a straight
/// edge of a blade enters and leaves by turns: so pairs in the order of time are the true ones.
void LoopStep::join_at(LoopFront& front, VertexId v) {
    for (bool is_done = false; !is_done;) {
        is_done = true;
        for (const FaceId f : faces_at(v)) {
            if (!front.waits(mesh_, f, v)) continue;
            const auto partner = waiting_partner(front, f, v);
            if (!partner) continue;
            join(front, f, v, *partner);
            is_done = false;  // faces have other numbers now
            break;
        }
    }
}

/// Joins nodes where the surface is there at once: all that it crosses are known. Of the two ways
/// to pair neighbours round a face, the shorter one is taken.
void LoopStep::join_all() {
    for (const VertexId v : made_)
        for (bool is_done = false; !is_done;) {
            is_done = true;
            for (const FaceId f : faces_at(v)) {
                if (!front_.waits(mesh_, f, v)) continue;
                std::vector<VertexId> waiting;
                for (int p = 0; p < mesh_.face_size(f); ++p)
                    if (const VertexId n = mesh_.face_corner(f, p); front_.waits(mesh_, f, n))
                        waiting.push_back(n);
                if (waiting.size() < 2) continue;
                const auto length_of = [&](std::size_t begin) {
                    double sum = 0.0;
                    for (std::size_t i = begin; i + 1 < waiting.size() + begin; i += 2)
                        sum += rest_length(waiting[i % waiting.size()],
                                           waiting[(i + 1) % waiting.size()]);
                    return sum;
                };
                const std::size_t begin = length_of(1) < length_of(0) ? 1 : 0;
                join(front_, f, waiting[begin], waiting[(begin + 1) % waiting.size()]);
                is_done = false;
                break;
            }
        }
}

/// Divides a face by an edge between two nodes of a cut.
void LoopStep::join(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    std::vector<VertexId> path = divide_face(f, v, w);
    if (path.size() > 2) front.put_on(path[1], front.local_edge_length(v));
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        front.mark(path[i], path[i + 1]);
        front.set_open(f.cell, path[i], path[i + 1]);
        if (other.is_valid()) front.set_open(other.cell, path[i], path[i + 1]);
    }
    for_cuts(&front, [&](const Cut& cut) { let_pass(cut, f.cell, path); });
    const VertexId end = path[1];
    // Other cuts can have divided the cells meanwhile.
    for (const CellId e : star(v))
        if (find_dart(mesh_, e, v, end).is_valid()) close(front, e, v, end);
}

/// Returns the cuts on which a face lies.
std::vector<LoopFront*> LoopStep::cuts_with(FaceId f) {
    std::vector<LoopFront*> found;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (cut.front.is_cut_face(mesh_, f)) found.push_back(&cut.front);
    });
    return found;
}

/// Divides a face by an edge between two of its corners, or by two edges if the cells at the face
/// have an edge between them. On the cuts on which the face lies, the edges are marked. Returns the
/// path of the edges.
std::vector<VertexId> LoopStep::divide_face(FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    const auto have_edge = [&](CellId e) { return find_dart(mesh_, e, v, w).is_valid(); };
    const LoopFront::Corner at_v = LoopFront::corner(mesh_, f, v),
                            at_w = LoopFront::corner(mesh_, f, w);
    const std::vector<LoopFront*> owners = cuts_with(f);
    std::vector<VertexId> path{v, w};
    if (have_edge(f.cell) || (other.is_valid() && have_edge(other.cell))) {
        const VertexId middle = edit_->divide_face_beside(f, v, w);
        std::vector<std::pair<VertexId, double>> sources;
        const topology::VertexRecord& record = edit_->added(middle);
        for (int k = 0; k < record.num_sources; ++k)
            sources.emplace_back(record.sources[static_cast<std::size_t>(k)].node,
                                 record.sources[static_cast<std::size_t>(k)].weight);
        place_new_node(middle, sources);
        path.insert(path.begin() + 1, middle);
    } else {
        edit_->divide_face(f, v, w);
    }
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for_cuts(nullptr, [&](const Cut& cut) {
        cut.front.divide(at_v, path[1]);
        cut.front.divide(at_w, path[path.size() - 2]);
    });
    for (LoopFront* front : owners)
        for (std::size_t i = 0; i + 1 < path.size(); ++i) front->mark(path[i], path[i + 1]);
    return path;
}

/// Returns the closed path of open edges of a cell that begins with an edge; empty if it is not
/// closed.
std::vector<VertexId> LoopStep::path_from(const LoopFront& front, CellId e, VertexId v,
                                          VertexId w) const {
    const std::vector<Edge>& open = front.open_edges(e);
    std::vector<VertexId> path{v, w};
    for (;;) {
        VertexId next;
        for (const Edge& edge : open) {
            if (edge.a != path.back() && edge.b != path.back()) continue;
            const VertexId far = edge.a == path.back() ? edge.b : edge.a;
            if (far == path[path.size() - 2]) continue;
            if (next.is_valid()) return {};  // two ways: it stays whole
            next = far;
        }
        if (!next.is_valid()) return {};
        if (next == v) return path;
        if (std::ranges::find(path, next) != path.end()) return {};
        path.push_back(next);
    }
}

/// Divides a cell if the edge completes a closed path.
void LoopStep::close(LoopFront& front, CellId e, VertexId v, VertexId w) {
    if (std::ranges::find(front.open_edges(e), edge_between(v, w)) == front.open_edges(e).end())
        return;
    const std::vector<VertexId> path = path_from(front, e, v, w);
    if (path.empty()) return;
    const CellId added = edit_->divide_cell(e, path);
    divided_.insert(divided_.end(), {e, added});
    for (auto& [n, begins] : rings_)
        for (CellId& begin : begins)
            if (begin == e && mesh_.corner_of(e, n) < 0) begin = added;
    front_.divide(mesh_, e, added);
    for (SuspendedLoops& blade : resting_) blade.front.divide(mesh_, e, added);
    for (std::size_t i = 0; i < path.size(); ++i)
        for (const CellId part : {e, added})
            front.set_closed(part, path[i], path[(i + 1) % path.size()]);
    const FaceId face{added, mesh_.num_faces(added) - 1};
    for_cuts(&front, [&](const Cut& cut) { make_wait_in(cut.front, face, path); });
    for_cuts(&front, [&](const Cut& cut) {
        if (cut.resting != nullptr || is_swept_)
            for (const VertexId n : path) join_at(cut.front, n);
    });
}

/// Divides a face, which lies on a cut, by a node in its middle.
void LoopStep::divide_at_centre(FaceId f) {
    const FaceId other = mesh_.neighbor(f);
    const int size = mesh_.face_size(f);
    std::vector<std::pair<VertexId, double>> sources;
    std::vector<LoopFront::Corner> corners;
    for (int p = 0; p < size; ++p) {
        sources.emplace_back(mesh_.face_corner(f, p), 1.0 / size);
        corners.push_back(LoopFront::corner(mesh_, f, sources.back().first));
    }
    const std::vector<LoopFront*> owners = cuts_with(f);
    std::vector<const LoopFront*> unsettled;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (!half_of(cut, f).is_settled()) unsettled.push_back(&cut.front);
    });
    const VertexId centre = edit_->divide_face_at_centre(f);
    place_new_node(centre, sources);
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for (const LoopFront::Corner& corner : corners) {
        for_cuts(nullptr, [&](const Cut& cut) { cut.front.divide(corner, centre); });
        for (LoopFront* front : owners) front->mark(corner.node, centre);
    }
    for (const LoopFront::Corner& corner : corners) {
        std::vector<VertexId> path{corner.node, centre};
        for_cuts(nullptr, [&](const Cut& cut) {
            if (std::ranges::find(unsettled, &cut.front) == unsettled.end())
                let_pass(cut, f.cell, path, true);
        });
    }
}

/// Divides the faces on cuts into triangles. They are plane then, and later cuts do not change the
/// volumes on their two sides.
void LoopStep::triangulate_all() {
    time_ = 1.0;
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    const auto is_done = [&](FaceId f) {
        return mesh_.face_size(f) == 3 || !mesh_.neighbor(f).is_valid() || cuts_with(f).empty();
    };
    passes_left_ = 64 + 8 * divided_.size();
    for (std::size_t i = 0; i < divided_.size(); ++i) {  // more are added
        const CellId e = divided_[i];
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            while (!is_done({e, f})) {
                if (const auto ends = next_ear(mesh_, {e, f})) {
                    std::vector<VertexId> path = divide_face({e, f}, ends->first, ends->second);
                    for_cuts(nullptr, [&](const Cut& cut) { let_pass(cut, e, path); });
                } else if (mesh_.face_size({e, f}) <= topology::max_corners) {
                    divide_at_centre({e, f});
                } else {
                    break;  // its corners lie on a line
                }
            }
    }
}

/// Opens the faces on this cut and on the suspended cuts.
void LoopStep::open_faces() {
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    for (const CellId e : divided_)
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f};
            if (!mesh_.neighbor(face).is_valid() || cuts_with(face).empty()) continue;
            report_.cut_area += topology::rest_area(mesh_, face);
            ++report_.faces_opened;
            edit_->open(face);
        }
}

}  // namespace incise::cutting
