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

/// Puts a node on a cut which it has made on an edge: the node waits in all faces there.
void LoopStep::wait_at(LoopFront& front, VertexId n, double local_edge_length) {
    front.put_on(n, local_edge_length);
    for (const FaceId f : faces_at(n)) front.set_waiting(mesh_, f, n, true);
}

/// Returns the other end of an edge of a face that the cut has made earlier, if the cut goes on at
/// both ends in a cell there: with the edge its path in the cell has no gap. In tissue that moves,
/// a blade that wavers beside its cut would part slices from it so.
std::optional<VertexId> LoopStep::end_of_gap(const LoopFront& front, FaceId f, VertexId v) const {
    const auto goes_on = [&](CellId e, VertexId n, VertexId but) {
        return std::ranges::any_of(front.open_edges(e), [&](const Edge& edge) {
            return (edge.a == n && edge.b != but) || (edge.b == n && edge.a != but);
        });
    };
    for (int p = 0; p < mesh_.face_size(f); ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        if (n == v || !front.waits(f, n) || !front.is_marked(v, n) || !is_edge_of(mesh_, f, v, n))
            continue;
        for (const CellId e : {f.cell, mesh_.neighbor(f).cell})
            if (e.is_valid() && goes_on(e, v, n) && goes_on(e, n, v)) return n;
    }
    return std::nullopt;
}

/// Returns another node that waits in the face, to be joined with the node: one that does not wait
/// there again. Of those that do two belong together, which the blade passed when it went back.
/// They are not joined, as the edge would lie beside the cut, but for the odd one, and where the
/// cut has a gap between them.
std::optional<VertexId> LoopStep::waiting_partner(const LoopFront& front, FaceId f,
                                                  VertexId v) const {
    std::optional<VertexId> first, again;
    bool is_odd = false;
    for (int p = 0; p < mesh_.face_size(f); ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        if (!front.waits(f, n)) continue;
        const bool waits_again = front.waits_again(mesh_, f, n);
        if (waits_again) is_odd = !is_odd;
        if (n != v && !(waits_again ? again : first)) (waits_again ? again : first) = n;
    }
    if (tissue_.is_at_rest)
        if (const auto n = end_of_gap(front, f, v)) return n;
    if (!front.waits_again(mesh_, f, v)) return first || !is_odd ? first : again;
    return is_odd ? first : std::nullopt;
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
                if ((other.is_valid() && other < face) || !front.waits(face, v)) continue;
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
                if (const VertexId n = mesh_.face_corner(f, p); front_.waits(f, n))
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

/// Takes a cut from one node that waits in a face to another one: along a new edge, or along an
/// edge of the face if the cut goes through one of the two, or has made the edge before.
void LoopStep::join(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    if ((front.is_marked(v, w) || front.is_through(v) || front.is_through(w)) &&
        is_edge_of(mesh_, f, v, w)) {
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
        for (const VertexId n : {v, w}) front.set_waiting(mesh_, part, n, false);
    cross_again(front, f.cell, path);
    let_all_pass(&front, f.cell, path);
    close_at(front, std::array{f.cell, other.cell}, v, path[1]);
}

/// Takes a cut along an edge of a face, between two nodes that wait there.
void LoopStep::join_along(LoopFront& front, FaceId f, VertexId v, VertexId w) {
    if (!front.is_marked(v, w)) front.set_along(v, w);
    for (const VertexId n : {v, w}) front.set_waiting(mesh_, f, n, false);
    const CellId cells[] = {f.cell, mesh_.neighbor(f).cell};
    std::vector<Edge> at_ends{edge_between(v, w)};
    for (const CellId e : cells) {
        if (!e.is_valid()) continue;
        if (front.is_open(e, v, w))
            front.set_closed(e, v, w);
        else
            front.set_open(e, v, w);
        // Without the edge, another path at its ends can be closed.
        for (const Edge& edge : front.open_edges(e))
            if (edge.a == v || edge.b == v || edge.a == w || edge.b == w) at_ends.push_back(edge);
    }
    for (const Edge& edge : at_ends) close_at(front, star(edge.a), edge.a, edge.b);
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
        if (cut.front.is_cut_face(f)) found.push_back(&cut.front);
    });
    return found;
}

/// Returns where a path in a face goes from one corner to another if not along a straight line:
/// that share of the way from the middle between the two to a corner. It is where the surface is,
/// if it crosses the way, as it does where it dips into the face.
std::pair<VertexId, double> LoopStep::place_beside(FaceId f, VertexId v, VertexId w) const {
    constexpr double usual = 0.05, most = 0.5;
    const Vec3 &a = mesh_.rest_position(v), along = mesh_.rest_position(w) - a;
    VertexId apex;
    double largest = -1.0;
    for (int p = 0; p < mesh_.face_size(f); ++p) {
        const VertexId n = mesh_.face_corner(f, p);
        const double size =
            n == v || n == w ? -1.0 : along.cross(mesh_.rest_position(n) - a).squaredNorm();
        if (size <= largest) continue;
        largest = size;
        apex = n;
    }
    MovingPoint middle = point(v);
    for (std::size_t i = 0; i < 2; ++i) middle[i] = 0.5 * (middle[i] + point(w)[i]);
    const EdgeIntersections found = intersections_of(surface_, middle, point(apex), 0.0);
    return {apex, found.empty() ? usual : std::clamp(found.front().place, least_place_, most)};
}

/// Divides a face by an edge between two of its corners, or by two edges if the cells at the face
/// have an edge between them. On the cuts on which the face lies, the edges are marked. Returns the
/// path of the edges.
std::vector<VertexId> LoopStep::divide_face(FaceId f, VertexId v, VertexId w) {
    const FaceId other = mesh_.neighbor(f);
    const auto have_edge = [&](CellId e) { return find_dart(mesh_, e, v, w).is_valid(); };
    const FaceStates states = take_states(f);
    std::vector<VertexId> path{v, w};
    if (have_edge(f.cell) || (other.is_valid() && have_edge(other.cell))) {
        const auto [apex, share] = place_beside(f, v, w);
        const VertexId middle = edit_->divide_face_beside(f, v, w, apex, share);
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
    const Dart d = find_dart(mesh_, f.cell, path[0], path[1]);
    for (const auto& [front, state] : states) {
        for (const FaceId part : {d.face, opposite(mesh_, d).face}) front->put(mesh_, part, state);
        for (std::size_t i = 0; i + 1 < path.size() && state.is_on_cut; ++i)
            front->mark(path[i], path[i + 1]);
    }
    return path;
}

/// Divides a face by a node in its middle, which it returns. On the cuts on which the face lies,
/// the edges are marked.
VertexId LoopStep::divide_face_at_centre(FaceId f) {
    const FaceId other = mesh_.neighbor(f);
    const int size = mesh_.face_size(f);
    std::vector<std::pair<VertexId, double>> sources;
    for (int p = 0; p < size; ++p) sources.emplace_back(mesh_.face_corner(f, p), 1.0 / size);
    const FaceStates states = take_states(f);
    const VertexId centre = edit_->divide_face_at_centre(f);
    place_new_node(centre, sources);
    divided_.push_back(f.cell);
    if (other.is_valid()) divided_.push_back(other.cell);
    for (const auto& [front, state] : states)
        for (const auto& [n, weight] : sources) {
            front->put(mesh_, find_dart(mesh_, f.cell, centre, n).face, state);
            if (state.is_on_cut) front->mark(n, centre);
        }
    return centre;
}

/// Forgets what the cuts do in a face that is to be divided, and returns it.
LoopStep::FaceStates LoopStep::take_states(FaceId f) {
    FaceStates states;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (LoopFront::FaceState state = cut.front.take(mesh_, f); !state.is_empty())
            states.emplace_back(&cut.front, std::move(state));
    });
    return states;
}

/// Divides a face, which lies on a cut, by a node in its middle.
void LoopStep::divide_at_centre(FaceId f) {
    std::vector<VertexId> corners;
    for (int p = 0; p < mesh_.face_size(f); ++p) corners.push_back(mesh_.face_corner(f, p));
    std::vector<const LoopFront*> unsettled;
    for_cuts(nullptr, [&](const Cut& cut) {
        if (!half_of(cut, f).is_settled()) unsettled.push_back(&cut.front);
    });
    const VertexId centre = divide_face_at_centre(f);
    Passed passed;
    for (const VertexId n : corners) {
        std::vector<VertexId> path{n, centre};
        for_cuts(nullptr, [&](const Cut& cut) {
            if (std::ranges::find(unsettled, &cut.front) == unsettled.end())
                let_pass(cut, f.cell, path, passed, true);
        });
    }
    join(passed);
}

/// Divides the new faces on cuts into triangles. They are plane then, and later cuts do not change
/// the volumes on their two sides.
void LoopStep::triangulate_all() {
    std::ranges::sort(divided_);
    divided_.erase(std::unique(divided_.begin(), divided_.end()), divided_.end());
    const auto is_done = [&](FaceId f) {
        if (mesh_.face_size(f) == 3 || !mesh_.neighbor(f).is_valid()) return true;
        bool is_new = false;
        for_cuts(nullptr, [&](const Cut& cut) {
            const LoopFront::FaceState& state = cut.front.state(f);
            is_new = is_new || (state.is_on_cut && !state.was_there);
        });
        return !is_new;
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
                        is_any = is_any || cut.front.waits({e, f}, n);
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
