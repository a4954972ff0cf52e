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

namespace {

bool is_edge_of(const topology::Mesh& mesh, FaceId f, VertexId a, VertexId b) {
    const LoopFront::Corner corner = LoopFront::corner(mesh, f, a);
    return corner.previous == b || corner.next == b;
}

}  // namespace

/// Divides an edge for all cuts.
VertexId LoopStep::divide_edge(VertexId a, VertexId b, double place) {
    std::vector<CellId> cells = star(a);
    std::erase_if(cells, [&](CellId e) { return !find_dart(mesh_, e, a, b).is_valid(); });
    assert(!cells.empty());
    divided_.insert(divided_.end(), cells.begin(), cells.end());
    const double length = rest_length(a, b);
    const VertexId middle = edit_->divide_edge(cells, a, b, place);
    place_new_node(middle, std::array{std::pair(a, 1.0 - place), std::pair(b, place)});
    note_rings(middle, a, cells);
    divide_pending(edge_between(a, b), middle, a < b ? place : 1.0 - place);
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

/// Returns another node that waits in the face, to be joined with the node: one that has no edge of
/// the cut there. Of nodes that have such an edge two belong together, which the blade passed when
/// it went back. They are not joined, as the edge would lie beside the cut, but for the odd one.
std::optional<VertexId> LoopStep::waiting_partner(const LoopFront& front, FaceId f,
                                                  VertexId v) const {
    std::optional<VertexId> free, joined;
    bool is_odd = false;
    for (int p = 0; p < mesh_.face_size(f); ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        const LoopFront::Corner corner = LoopFront::corner(mesh_, f, n);
        if (!front.waits(corner)) continue;
        const bool is_joined = front.is_joined(corner);
        if (is_joined) is_odd = !is_odd;
        if (n != v && !(is_joined ? joined : free)) (is_joined ? joined : free) = n;
    }
    if (!front.is_joined(LoopFront::corner(mesh_, f, v))) return free || !is_odd ? free : joined;
    return is_odd ? free : std::nullopt;
}

/// Passes the faces at a node in which it waits. After divide(face) has returned true, faces have
/// other numbers, and there may be more of them.
template <class Divide>
void LoopStep::for_faces_where_waits(const LoopFront& front, VertexId v, Divide divide) {
    for (bool is_done = false; !is_done;) {
        is_done = true;
        for (const CellId e : star(v))
            for (int f = 0; f < mesh_.num_faces(e); ++f) {
                const FaceId face{e, f}, other = mesh_.neighbor(face);
                if ((other.is_valid() && other < face) || !front.waits(mesh_, face, v)) continue;
                if (!divide(face)) continue;
                is_done = false;
                f = -1;
            }
    }
}

/// Joins a node with those that wait for it in the faces at it. In a face that is plane, a straight
/// edge of a blade enters and leaves by turns: so pairs in the order of time are the true ones.
void LoopStep::join_at(LoopFront& front, VertexId v) {
    for_faces_where_waits(front, v, [&](FaceId f) {
        const auto partner = waiting_partner(front, f, v);
        if (partner) join(front, f, v, *partner);
        return partner.has_value();
    });
}

/// Joins nodes where the surface is there at once: all that it crosses are known. Of the two ways
/// to pair neighbours round a face, the shorter one is taken.
void LoopStep::join_all() {
    for (const VertexId v : made_)
        for_faces_where_waits(front_, v, [&](FaceId f) {
            std::vector<VertexId> waiting;
            for (int p = 0; p < mesh_.face_size(f); ++p)
                if (const VertexId n = mesh_.face_corner(f, p); front_.waits(mesh_, f, n))
                    waiting.push_back(n);
            if (waiting.size() < 2) return false;
            const auto length_of = [&](std::size_t begin) {
                double sum = 0.0;
                for (std::size_t i = begin; i + 1 < waiting.size() + begin; i += 2)
                    sum +=
                        rest_length(waiting[i % waiting.size()], waiting[(i + 1) % waiting.size()]);
                return sum;
            };
            const std::size_t begin = length_of(1) < length_of(0) ? 1 : 0;
            join(front_, f, waiting[begin], waiting[(begin + 1) % waiting.size()]);
            return true;
        });
}

/// Divides a face by an edge between two nodes of a cut.
void LoopStep::join(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    if (front.is_marked(v, w) && is_edge_of(mesh_, f, v, w)) {
        join_along(front, f, v, w);
        return;
    }
    std::vector<VertexId> path = divide_face(f, v, w);
    if (path.size() > 2) front.put_on(path[1], front.local_edge_length(v));
    for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        front.mark(path[i], path[i + 1]);
        front.set_open(f.cell, path[i], path[i + 1]);
        if (other.is_valid()) front.set_open(other.cell, path[i], path[i + 1]);
    }
    const Dart along = find_dart(mesh_, f.cell, path[0], path[1]);
    for (const FaceId part : {along.face, opposite(mesh_, along).face})
        for (const VertexId n : {v, w}) front.set_waiting(LoopFront::corner(mesh_, part, n), false);
    cross_again(front, f.cell, path);
    let_all_pass(&front, f.cell, path);
    close_at(front, std::array{f.cell, other.cell}, v, path[1]);
}

/// Joins two nodes of a cut that wait in a face, along an edge of the face that is on the cut.
void LoopStep::join_along(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    for (const VertexId n : {v, w}) front.set_waiting(LoopFront::corner(mesh_, f, n), false);
    const CellId cells[] = {f.cell, mesh_.neighbor(f).cell};
    for (const CellId e : cells) {
        if (!e.is_valid()) continue;
        const std::vector<Edge>& open = front.open_edges(e);
        if (std::ranges::find(open, edge_between(v, w)) != open.end())
            front.set_closed(e, v, w);
        else
            front.set_open(e, v, w);
    }
    close_at(front, cells, v, w);
    // Without the edge, another path at its ends can be closed.
    for (const CellId e : cells)
        for (const Edge& edge : std::vector(front.open_edges(e)))
            if (edge.a == v || edge.b == v || edge.a == w || edge.b == w)
                close_at(front, std::array{e}, edge.a, edge.b);
}

/// Divides those of the cells at an edge where it completes a closed path.
/// @param cells  at a face with the edge; some may be invalid
void LoopStep::close_at(LoopFront& front, std::span<const CellId> cells, VertexId v, VertexId w) {
    // Other cuts can have divided the cells meanwhile.
    const std::vector<CellId> all =
        resting_.empty() ? std::vector(cells.begin(), cells.end()) : star(v);
    for (const CellId e : all)
        if (e.is_valid() && find_dart(mesh_, e, v, w).is_valid()) close(front, e, v, w);
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
        sources.reserve(static_cast<std::size_t>(record.num_sources));
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

/// Goes round a node of a cell, from an edge that comes to it, to the next place where the cut is:
/// an open edge, or a corner at which the node waits. Returns the other end of the edge; an invalid
/// id at a corner, and if there is only the edge from which it starts.
/// @param arriving  the dart to the node
/// @param is_left   true to turn to the faces on the left of the dart first
VertexId LoopStep::turn(const LoopFront& front, Dart arriving, bool is_left) const {
    const VertexId n = to(mesh_, arriving), start = from(mesh_, arriving);
    const std::vector<Edge>& open = front.open_edges(arriving.face.cell);
    Dart side = is_left ? arriving : opposite(mesh_, arriving);  // in a face at the node
    for (int left = mesh_.num_faces(side.face.cell); left > 0; --left) {
        const Dart leaving = is_left ? next(mesh_, side) : previous(mesh_, side);
        const VertexId end = is_left ? to(mesh_, leaving) : from(mesh_, leaving);
        if (front.waits(mesh_, side.face, n) || end == start) return {};
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
/// node: open edges, and corners at which the node waits.
bool LoopStep::parts_evenly(const LoopFront& front, CellId e, VertexId from_node, VertexId n,
                            VertexId to_node) const {
    const std::vector<Edge>& open = front.open_edges(e);
    bool is_even = true;
    Dart side = find_dart(mesh_, e, from_node, n);
    for (int left = mesh_.num_faces(e); left > 0; --left) {
        if (front.waits(mesh_, side.face, n)) is_even = !is_even;
        const Dart leaving = next(mesh_, side);
        const VertexId end = to(mesh_, leaving);
        if (end == to_node || end == from_node) return is_even;
        if (std::ranges::find(open, edge_between(n, end)) != open.end()) is_even = !is_even;
        side = opposite(mesh_, leaving);
    }
    return false;
}

/// Divides a cell if the edge completes a closed path.
void LoopStep::close(LoopFront& front, CellId e, VertexId v, VertexId w) {
    if (std::ranges::find(front.open_edges(e), edge_between(v, w)) == front.open_edges(e).end())
        return;
    if (&front == &front_ && stays_whole(e)) return;
    const std::vector<VertexId> path = path_from(front, e, v, w);
    if (path.empty()) return;
    const CellId added = edit_->divide_cell(e, path);
    if (only_ && !stays_whole(e)) only_->insert(added);
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
    // The path can be another one, which touches that of the edge.
    for (const CellId part : {e, added})
        if (find_dart(mesh_, part, v, w).is_valid()) close(front, part, v, w);
}

/// Divides the cells that were to stay whole, but that the cut has come all round.
void LoopStep::close_all() {
    only_.reset();
    for (std::size_t before = 0; before != mesh_.element_capacity();) {
        before = mesh_.element_capacity();  // a part can have another closed path
        for (const CellId e : front_.open_cells())
            for (const Edge& edge : std::vector(front_.open_edges(e)))
                close(front_, e, edge.a, edge.b);
    }
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
    Passed passed;
    for (const LoopFront::Corner& corner : corners) {
        std::vector<VertexId> path{corner.node, centre};
        for_cuts(nullptr, [&](const Cut& cut) {
            if (std::ranges::find(unsettled, &cut.front) == unsettled.end())
                let_pass(cut, f.cell, path, passed, true);
        });
    }
    join(passed);
}

/// Divides the faces on cuts into triangles. They are plane then, and later cuts do not change the
/// volumes on their two sides.
void LoopStep::triangulate_all() {
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    const auto is_done = [&](FaceId f) {
        return mesh_.face_size(f) == 3 || !mesh_.neighbor(f).is_valid() || cuts_with(f).empty();
    };
    passes_left_ = most_passes(divided_.size());
    // NOLINTNEXTLINE(modernize-loop-convert): the list grows in the loop
    for (std::size_t i = 0; i < divided_.size(); ++i) {
        const CellId e = divided_[i];
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            while (!is_done({e, f})) {
                const auto waits = [&](VertexId n) {
                    bool is_any = false;
                    for_cuts(nullptr, [&](const Cut& cut) {
                        is_any = is_any || cut.front.waits(mesh_, {e, f}, n);
                    });
                    return is_any;
                };
                const int size = mesh_.face_size({e, f});
                int num_waiting = 0;
                for (int p = 0; p < size; ++p) num_waiting += waits(mesh_.face_corner({e, f}, p));
                // Two cuts that go to the same place would pass each edge, and wait there again.
                if (num_waiting > 1 && size <= num_waiting + 2) break;
                if (const auto ends = next_ear(mesh_, {e, f}, waits)) {
                    std::vector<VertexId> path = divide_face({e, f}, ends->first, ends->second);
                    let_all_pass(nullptr, e, path);
                } else if (size <= topology::max_corners) {
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
