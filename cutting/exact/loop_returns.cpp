// What a blade makes of its own cut, or of one that has ended, where it comes to it again.
// Source: docs/cutting.md, Cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "incise/cutting/exact/loop_step.h"
#include "incise/cutting/exact/side_sets.h"
#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::Dart;

/// Goes on with those earlier cuts to nodes of which the blade comes, and along which it goes.
/// Others are as if suspended where this one comes to their cells.
void LoopStep::meet_earlier_cuts() {
    if (earlier_.unfinished.empty()) return;
    std::vector<CellId> cells = crossed_;  // and those at this cut, which it may come to divide
    front_.for_each([&](VertexId n) { std::ranges::copy(star(n), std::back_inserter(cells)); });
    for (SuspendedLoops& cut : earlier_.unfinished) {
        const bool is_at_cut = std::ranges::any_of(cells, [&](CellId e) {
            return std::ranges::any_of(mesh_.corners(e),
                                       [&](VertexId n) { return cut.front.is_on(n); });
        });
        if (!is_at_cut) continue;
        if (is_swept_ && !only_ && goes_along(cut.front) && front_.add(cut.front))
            cut.front = {};
        else
            resting_.push_back(cut);
    }
}

/// True if the surface goes along another cut at a node of that.
bool LoopStep::goes_along(const LoopFront& cut) const {
    return std::ranges::any_of(pending_, [&](const auto& entry) {
        const auto& [edge, intersections] = entry;
        return std::ranges::any_of(intersections, [&](const EdgeIntersection& x) {
            return std::ranges::any_of(nodes_near(cut, edge, x), [&](VertexId n) {
                return n.is_valid() && is_along(cut, n, x.normal);
            });
        });
    });
}

/// Returns the ends of an edge, nodes of a cut, to which the surface comes so near that it passes
/// the edge there; the nearer one first. A blade that comes again to a cut comes not exactly to the
/// same place, as tissue moves: it is not to cut slices off the cut. But where it turns, it leaves
/// the cut at once.
std::array<VertexId, 2> LoopStep::nodes_near(const LoopFront& cut, const Edge& edge,
                                             const EdgeIntersection& x) const {
    const double length = rest_length(edge.a, edge.b);
    const bool is_marked = cut.lies_on(edge.a, edge.b);
    const auto if_near = [&](VertexId n, double distance) {
        if (!cut.is_on(n)) return VertexId();
        const double share = distance / cut.local_edge_length(n);
        bool is_near = is_marked || share < nearness;
        if (is_swept_ && !is_marked)
            is_near =
                share < nearness_of_blade && (!tissue_.is_at_rest || share < nearness_at_rest ||
                                              cut.is_added(n) || is_along(cut, n, x.normal));
        return is_near ? n : VertexId();
    };
    std::array<VertexId, 2> found{if_near(edge.a, x.place * length),
                                  if_near(edge.b, (1.0 - x.place) * length)};
    if (x.place > 0.5) std::swap(found[0], found[1]);
    return found;
}

/// True if a surface with a normal goes along a cut at a node of it.
bool LoopStep::is_along(const LoopFront& cut, VertexId n, const Vec3& normal) const {
    constexpr double largest_sine = 0.1;
    const std::vector<VertexId>& others = cut.marked_at(n);
    return !others.empty() && std::ranges::all_of(others, [&](VertexId other) {
        const Vec3 d = point(other)[1] - point(n)[1];
        const double noise = nearness * cut.local_edge_length(n);  // of the places of nodes
        return std::abs(normal.dot(d)) <= std::max(largest_sine * d.norm(), noise);
    });
}

/// Returns the end of an edge, a node of this cut, at which the cut passes to the other side of the
/// edge, if it is not to get a node there: the blade has come back to the node, or has not left it
/// yet; or the edge lies on the cut, and the nodes at its ends not exactly where the blade is.
std::optional<VertexId> LoopStep::own_node_at(const Edge& edge, const EdgeIntersection& x) const {
    if (const VertexId node = front_.passed_at(edge.a, edge.b); node.is_valid()) return node;
    for (const VertexId node : nodes_near(front_, edge, x))
        if (node.is_valid()) return node;
    return std::nullopt;
}

/// Takes this cut, which goes through a node, to the other side of an edge there.
void LoopStep::pass_at(VertexId v, VertexId end) {
    for (const FaceId f : faces_at(v))
        if (is_edge_of(mesh_, f, v, end)) front_.set_waiting(mesh_, f, v, !front_.waits(f, v));
}

/// Where a node waits in a face, and only an edge that the blade has passed at another node of the
/// cut can be where the cut leaves the face again, takes the cut to the other side of that edge.
void LoopStep::settle() {
    std::vector<VertexId> nodes = made_;
    nodes.insert(nodes.end(), met_again_.begin(), met_again_.end());
    for (std::size_t i = 0; i < nodes.size(); ++i)  // more are added
        for (bool is_done = false; !is_done && passes_left_ > 0;) {
            is_done = true;
            for (const FaceId f : faces_at(nodes[i])) {
                const auto edge = edge_to_pass(f);
                if (!edge) continue;
                --passes_left_;
                front_.toggle_passed(*edge);
                pass_at(edge->node, edge->end);
                join_at(front_, edge->node);
                if (tissue_.is_at_rest) nodes.push_back(edge->node);
                is_done = false;
                break;
            }
        }
}

/// Returns the edge of a face to whose other side the cut is to go, so that it leaves the face
/// where the one node that waits there has no partner; nothing if there is no such node or edge.
std::optional<LoopFront::EdgeAt> LoopStep::edge_to_pass(FaceId f) const {
    int num_waiting = 0;
    std::optional<LoopFront::EdgeAt> found;
    bool is_odd = false;
    const int size = mesh_.face_size(f);
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(f, p), after = mesh_.face_corner(f, (p + 1) % size);
        if (front_.waits(f, n)) ++num_waiting;
        const VertexId node = front_.passed_at(n, after);
        if (!node.is_valid()) continue;
        is_odd = !is_odd;
        if (!found && !front_.waits(f, node))
            found = LoopFront::EdgeAt{node, node == n ? after : n};
    }
    if (num_waiting != 1 || !is_odd) return std::nullopt;
    return found;
}

/// True if this cut parts nodes of a cell from others, and its blade is not in the cell.
bool LoopStep::parts_nodes(CellId e) const {
    // The two ends of each edge of each face of the cell, as seen in the face.
    std::vector<std::size_t> begins;
    std::size_t count = 0;
    for (int f = 0; f < mesh_.num_faces(e); ++f) {
        begins.push_back(count);
        count += 2 * static_cast<std::size_t>(mesh_.face_size({e, f}));
    }
    const auto end_of = [&](const Dart& d, bool is_second) {
        return begins[static_cast<std::size_t>(d.face.face)] +
               2 * static_cast<std::size_t>(d.position) + (is_second ? 1 : 0);
    };
    const auto is_on_a_cut = [&](FaceId f) { return mesh_.is_on_cut(f) || front_.is_cut_face(f); };
    std::vector<VertexId> on_cuts;
    for (int f = 0; f < mesh_.num_faces(e); ++f)
        if (is_on_a_cut({e, f}))
            for (int p = 0; p < mesh_.face_size({e, f}); ++p)
                on_cuts.push_back(mesh_.face_corner({e, f}, p));
    const std::vector<Edge>& open = front_.open_edges(e);
    SideSets sides(count);
    std::optional<std::size_t> first;
    std::vector<std::size_t> others;
    for (int f = 0; f < mesh_.num_faces(e); ++f) {
        // The blade is beside such a face as often as behind it: there it says nothing.
        const bool is_on_cut = is_on_a_cut({e, f});
        for (int p = 0; p < mesh_.face_size({e, f}); ++p) {
            const Dart d{{e, f}, p}, twin = opposite(mesh_, d);
            const VertexId n = from(mesh_, d), after = to(mesh_, d);
            const bool is_open = std::ranges::find(open, edge_between(n, after)) != open.end();
            if (!sides.relate(end_of(d, false), end_of(d, true),
                              front_.passed_at(n, after).is_valid()) ||
                (!is_on_cut && !sides.relate(end_of(d, true), end_of(next(mesh_, d), false),
                                             front_.waits(d.face, after))) ||
                !sides.relate(end_of(d, false), end_of(twin, true), is_open))
                return false;
            if (front_.is_on(n) || std::ranges::find(on_cuts, n) != on_cuts.end()) continue;
            if (first)
                others.push_back(end_of(d, false));
            else
                first = end_of(d, false);
        }
    }
    return std::ranges::any_of(others, [&](std::size_t i) { return sides.are_parted(*first, i); });
}

/// Divides the cells of which this cut parts nodes from others, while their open edges do not form
/// closed paths: the blade has passed some edges at nodes that the cut had before, and then the
/// path goes on along a face that the cut has made before.
void LoopStep::close_parted() {
    if (!front_.has_passed_edges()) return;
    for (bool is_done = false; !is_done;) {  // it adds cells, and opens edges in others
        is_done = true;
        for (const CellId e : front_.open_cells())
            while (passes_left_ > 0 && parts_nodes(e) && lengthen_path(e)) {
                --passes_left_;
                is_done = false;
            }
    }
}

/// Lengthens a path of open edges of a cell by one edge, in a face in which the cut waits at an end
/// of it. If it waits nowhere else in the face, takes it to the other side of an edge that the
/// blade has passed. Returns false if there is no such face.
bool LoopStep::lengthen_path(CellId e) {
    std::vector<VertexId> ends;  // of paths: nodes at an odd number of open edges
    for (const Edge& edge : front_.open_edges(e))
        for (const VertexId n : {edge.a, edge.b})
            if (const auto it = std::ranges::find(ends, n); it == ends.end())
                ends.push_back(n);
            else
                ends.erase(it);
    std::ranges::sort(ends);
    const auto is_end = [&](VertexId n) { return std::ranges::binary_search(ends, n); };
    std::optional<std::pair<Dart, VertexId>> found;  // the corner of an end, and the next node
    for (int f = 0; f < mesh_.num_faces(e); ++f)
        for (int p = 0; p < mesh_.face_size({e, f}); ++p) {
            const Dart d{{e, f}, p};
            const VertexId n = from(mesh_, d);
            if (!is_end(n) || !front_.waits(d.face, n)) continue;
            for (int q = 0; q < mesh_.face_size(d.face); ++q) {
                const VertexId other = mesh_.face_corner(d.face, q);
                if (other == n || !front_.waits(d.face, other)) continue;
                if (!found || (is_end(other) && !is_end(found->second))) found = {d, other};
            }
        }
    if (found) {
        const auto [d, other] = *found;
        join(front_, d.face, from(mesh_, d), other);
        return true;
    }
    for (int f = 0; f < mesh_.num_faces(e); ++f) {
        const int size = mesh_.face_size({e, f});
        for (int p = 0; p < size; ++p) {
            const VertexId n = mesh_.face_corner({e, f}, p);
            if (!is_end(n) || !front_.waits({e, f}, n)) continue;
            for (int q = 0; q < size; ++q) {
                const VertexId a = mesh_.face_corner({e, f}, q),
                               b = mesh_.face_corner({e, f}, (q + 1) % size),
                               node = front_.passed_at(a, b);
                if (!node.is_valid()) continue;
                const LoopFront::EdgeAt edge{node, node == a ? b : a};
                front_.toggle_passed(edge);
                pass_at(edge.node, edge.end);
                join_at(front_, edge.node);
                return true;
            }
        }
    }
    return false;
}

}  // namespace incise::cutting
