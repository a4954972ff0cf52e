// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/loop_front.h"

#include <unordered_set>
#include <utility>

#include "incise/topology/darts.h"

namespace incise::cutting {

using topology::ChangeSet;
using topology::Mesh;

namespace {

template <class T>
void insert_sorted(std::vector<T>& values, const T& value) {
    values.insert(std::ranges::lower_bound(values, value), value);
}

}  // namespace

void LoopFront::mark(VertexId a, VertexId b) {
    if (is_marked(a, b)) return;
    insert_sorted(marked_[a], b);
    insert_sorted(marked_[b], a);
}

std::vector<CellId> LoopFront::open_cells() const {
    std::vector<CellId> cells;
    for (const auto& entry : open_) cells.push_back(entry.first);
    std::ranges::sort(cells);
    return cells;
}

void LoopFront::set_closed(CellId e, VertexId a, VertexId b) {
    const auto it = open_.find(e);
    if (it == open_.end()) return;
    std::erase(it->second, edge_between(a, b));
    if (it->second.empty()) open_.erase(it);
}

void LoopFront::divide(const Mesh& mesh, CellId kept, CellId added) {
    const auto it = open_.find(kept);
    if (it == open_.end()) return;
    std::vector<Edge> stay, leave;
    for (const Edge& edge : it->second)
        (find_dart(mesh, kept, edge.a, edge.b).is_valid() ? stay : leave).push_back(edge);
    open_.erase(it);
    if (!stay.empty()) open_[kept] = std::move(stay);
    if (!leave.empty()) open_[added] = std::move(leave);
}

void LoopFront::divide(VertexId a, VertexId b, VertexId middle, double local_edge_length) {
    for (const auto& [n, other] : {std::pair(a, b), std::pair(b, a)})
        if (const auto it = switched_.find(n); it != switched_.end())
            for (Edge& neighbours : it->second)
                if (neighbours.a == other || neighbours.b == other)
                    neighbours =
                        edge_between(neighbours.a == other ? neighbours.b : neighbours.a, middle);
    if (const auto it = passed_.find(edge_between(a, b)); it != passed_.end()) {
        const VertexId node = it->second;
        passed_.erase(it);
        toggle_passed({node, middle});
    }
    if (!is_marked(a, b)) return;
    std::erase(marked_[a], b);
    std::erase(marked_[b], a);
    mark(a, middle);
    mark(middle, b);
    const Edge whole = edge_between(a, b);
    for (auto& [e, edges] : open_) {
        const auto it = std::ranges::find(edges, whole);
        if (it == edges.end()) continue;
        *it = edge_between(a, middle);
        edges.push_back(edge_between(middle, b));
        put_on(middle, local_edge_length);
    }
}

VertexId LoopFront::passed_at(VertexId a, VertexId b) const {
    const auto it = passed_.find(edge_between(a, b));
    return it != passed_.end() ? it->second : VertexId();
}

void LoopFront::toggle_passed(const PassedEdge& edge) {
    const auto [it, is_new] = passed_.emplace(edge_between(edge.node, edge.end), edge.node);
    if (!is_new) passed_.erase(it);
}

bool LoopFront::add(const Mesh& mesh, const LoopFront& other) {
    for (const auto& entry : other.nodes_)
        if (is_on(entry.first)) return false;
    // The marked edges of one cut make no difference to where the other one waits.
    std::vector<std::pair<Corner, bool>> corners;
    const auto keep_corners = [&](const LoopFront& cut, const LoopFront& marks) {
        std::vector<CellId> star;
        for (const auto& [n, ends] : marks.marked_) {
            if (!cut.is_on(n)) continue;
            mesh.star(n, star);
            for (const CellId e : star)
                for (int f = 0; f < mesh.num_faces(e); ++f)
                    if (const Corner at = corner(mesh, {e, f}, n); at.next.is_valid())
                        corners.emplace_back(at, cut.waits(at));
        }
    };
    keep_corners(*this, other);
    keep_corners(other, *this);
    nodes_.insert(other.nodes_.begin(), other.nodes_.end());
    for (const auto& [a, ends] : other.marked_)
        for (const VertexId b : ends) mark(a, b);
    switched_.insert(other.switched_.begin(), other.switched_.end());
    for (const auto& [e, edges] : other.open_)
        open_[e].insert(open_[e].end(), edges.begin(), edges.end());
    for (const auto& [edge, node] : other.passed_)  // one that both have passed is not passed
        toggle_passed({node, node == edge.a ? edge.b : edge.a});
    for (const auto& [at, waits_there] : corners) set_waiting(at, waits_there);
    return true;
}

LoopFront::Corner LoopFront::corner(const Mesh& mesh, FaceId f, VertexId n) {
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p)
        if (mesh.face_corner(f, p) == n)
            return {n, mesh.face_corner(f, (p + size - 1) % size),
                    mesh.face_corner(f, (p + 1) % size)};
    return {n, {}, {}};
}

bool LoopFront::is_switched(const Corner& corner) const {
    const auto it = switched_.find(corner.node);
    return it != switched_.end() &&
           std::ranges::find(it->second, edge_between(corner.previous, corner.next)) !=
               it->second.end();
}

bool LoopFront::waits(const Corner& corner) const {
    if (!corner.next.is_valid() || !is_on(corner.node)) return false;
    return is_joined(corner) == is_switched(corner);
}

bool LoopFront::waits(const Mesh& mesh, FaceId f, VertexId n) const {
    return is_on(n) && waits(corner(mesh, f, n));
}

void LoopFront::set_waiting(const Corner& corner, bool is_to_wait) {
    if (waits(corner) == is_to_wait) return;
    std::vector<Edge>& at_node = switched_[corner.node];
    const Edge neighbours = edge_between(corner.previous, corner.next);
    if (is_switched(corner))
        std::erase(at_node, neighbours);
    else
        at_node.push_back(neighbours);
    if (at_node.empty()) switched_.erase(corner.node);
}

void LoopFront::divide(const Corner& corner, VertexId end) {
    if (!is_on(corner.node)) return;
    const bool did_wait = waits(corner);
    if (is_switched(corner)) set_waiting(corner, !did_wait);
    for (const VertexId neighbour : {corner.previous, corner.next})
        set_waiting({corner.node, neighbour, end}, did_wait);
}

bool LoopFront::is_cut_face(const Mesh& mesh, FaceId f) const {
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p)
        if (!is_marked(mesh.face_corner(f, p), mesh.face_corner(f, (p + 1) % size))) return false;
    return true;
}

bool LoopFront::is_on(const Mesh& mesh) const {
    const auto is_there = [&](VertexId n) { return n.index() < mesh.node_capacity(); };
    const auto are_there = [&](const std::vector<Edge>& edges) {
        return std::ranges::all_of(
            edges, [&](const Edge& edge) { return is_there(edge.a) && is_there(edge.b); });
    };
    const auto all_of = [](const auto& map, auto test) {
        return std::ranges::all_of(
            map, [&](const auto& entry) { return test(entry.first, entry.second); });
    };
    return all_of(nodes_, [&](VertexId n, double) { return is_there(n); }) &&
           all_of(marked_,
                  [&](VertexId n, const std::vector<VertexId>& others) {
                      return is_there(n) && std::ranges::all_of(others, is_there);
                  }) &&
           all_of(switched_,
                  [&](VertexId n, const std::vector<Edge>& neighbours) {
                      return is_there(n) && are_there(neighbours);
                  }) &&
           all_of(open_,
                  [&](CellId e, const std::vector<Edge>& edges) {
                      return e.index() < mesh.element_capacity() && mesh.is_alive(e) &&
                             std::ranges::all_of(edges, [&](const Edge& edge) {
                                 return find_dart(mesh, e, edge.a, edge.b).is_valid();
                             });
                  }) &&
           all_of(passed_, [&](const Edge& edge, VertexId node) {
               return is_there(edge.a) && is_there(edge.b) && (node == edge.a || node == edge.b);
           });
}

/// Marked edges to other nodes on the cut stay: these do not wait in the faces there.
void LoopFront::forget(VertexId n) {
    nodes_.erase(n);
    if (const auto it = marked_.find(n); it != marked_.end()) {
        for (const VertexId other : std::vector(it->second)) {
            if (is_on(other)) continue;
            std::erase(marked_[n], other);
            std::erase(marked_[other], n);
            if (marked_[other].empty()) marked_.erase(other);
        }
        if (marked_[n].empty()) marked_.erase(n);
    }
    switched_.erase(n);
    std::erase_if(passed_,
                  [&](const auto& entry) { return entry.first.a == n || entry.first.b == n; });
}

void LoopFront::forget(std::span<const VertexId> nodes) {
    for (const VertexId n : nodes) {
        if (!is_on(n)) continue;
        forget(n);
        for (auto& entry : open_)
            std::erase_if(entry.second, [&](const Edge& x) { return x.a == n || x.b == n; });
    }
    std::erase_if(open_, [](const auto& entry) { return entry.second.empty(); });
}

void LoopFront::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (is_empty()) return;
    std::unordered_map<VertexId, std::vector<VertexId>> copies;
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const VertexId source = record.sources[0].node;
        copies[source].push_back(record.id);
        if (const auto it = nodes_.find(source); it != nodes_.end()) {
            const double local_edge_length = it->second;
            nodes_.try_emplace(record.id, local_edge_length);
        }
    }
    if (!copies.empty()) {
        const auto all_of = [&](VertexId n) {
            std::vector<VertexId> all{n};
            if (const auto it = copies.find(n); it != copies.end())
                all.insert(all.end(), it->second.begin(), it->second.end());
            return all;
        };
        std::vector<CellId> star;
        const auto has_edge = [&](VertexId a, VertexId b) {
            if (!mesh.is_alive(a) || !mesh.is_alive(b)) return false;
            mesh.star(a, star);
            return std::ranges::any_of(
                star, [&](CellId e) { return find_dart(mesh, e, a, b).is_valid(); });
        };
        const auto follow = [&](VertexId a, VertexId b, auto add) {
            for (const VertexId x : all_of(a))
                for (const VertexId y : all_of(b))
                    if (has_edge(x, y)) add(x, y);
        };
        const auto has_copies = [&](VertexId a, VertexId b) {
            return copies.contains(a) || copies.contains(b);
        };
        const auto before = std::exchange(marked_, {});
        for (const auto& [a, others] : before)
            for (const VertexId b : others) {
                if (b < a) continue;
                if (has_copies(a, b))
                    follow(a, b, [&](VertexId x, VertexId y) { mark(x, y); });
                else
                    mark(a, b);
            }
        const auto switched = std::exchange(switched_, {});
        for (const auto& [n, corners] : switched)
            for (const Edge& neighbours : corners)
                for (const VertexId x : all_of(n))
                    for (const VertexId a : all_of(neighbours.a))
                        for (const VertexId b : all_of(neighbours.b))
                            switched_[x].push_back(edge_between(a, b));
        const auto passed = std::exchange(passed_, {});
        for (const auto& [edge, node] : passed)
            follow(node, node == edge.a ? edge.b : edge.a,
                   [&](VertexId x, VertexId y) { passed_[edge_between(x, y)] = x; });
        for (auto& [e, edges] : open_) {
            std::vector<Edge> now;
            for (const Edge& edge : edges)
                for (const VertexId x : all_of(edge.a))
                    for (const VertexId y : all_of(edge.b))
                        if (find_dart(mesh, e, x, y).is_valid()) now.push_back(edge_between(x, y));
            edges = std::move(now);
        }
    }
    for (const topology::CellRecord& record : changes.elements_removed) open_.erase(record.id);
    for (const topology::VertexRecord& record : changes.nodes_removed) forget(record.id);
}

void LoopFront::leave_behind(const Mesh& mesh) {
    std::unordered_set<VertexId> at_work;  // round which something waits or is open
    for (const auto& [e, edges] : open_)
        for (const Edge& edge : edges) at_work.insert({edge.a, edge.b});
    std::vector<CellId> star;
    const auto for_faces_at = [&](VertexId n, auto visit) {
        mesh.star(n, star);
        for (const CellId e : star)
            for (int f = 0; f < mesh.num_faces(e); ++f)
                if (corner(mesh, {e, f}, n).next.is_valid()) visit(FaceId{e, f});
    };
    for (const auto& entry : nodes_)
        for_faces_at(entry.first, [&](FaceId f) {
            const Corner at = corner(mesh, f, entry.first);
            if (waits(at) && !is_joined(at)) at_work.insert(at.node);
        });
    std::unordered_set<VertexId> needed;
    const auto need = [&](VertexId n) {
        if (is_on(n)) needed.insert(n);
    };
    const auto need_all = [&](FaceId f) {
        for (int p = 0; p < mesh.face_size(f); ++p) need(mesh.face_corner(f, p));
    };
    for (const VertexId n : at_work) need(n);
    // Cut faces at these nodes are known to be such while they have all their marked edges.
    for (const VertexId n : at_work)
        for_faces_at(n, [&](FaceId f) {
            if (is_cut_face(mesh, f)) need_all(f);
        });
    // The cut comes into each face as often as it goes out, also without those that are forgotten.
    const auto is_left = [&](VertexId n) { return is_on(n) && !needed.contains(n); };
    const auto loses_odd_number = [&](FaceId f) {
        const int size = mesh.face_size(f);
        bool is_odd = false;
        for (int p = 0; p < size; ++p) {
            const VertexId n = mesh.face_corner(f, p), next = mesh.face_corner(f, (p + 1) % size);
            if (is_left(n)) is_odd ^= waits(mesh, f, n);
            if (is_left(n) || is_left(next)) is_odd ^= passed_at(n, next).is_valid();
        }
        return is_odd;
    };
    if (!passed_.empty() || !switched_.empty())
        for (bool is_done = false; !is_done;) {
            std::vector<FaceId> odd;  // all that are, so that the order of the nodes is nothing
            for (const auto& entry : nodes_)
                if (is_left(entry.first))
                    for_faces_at(entry.first, [&](FaceId f) {
                        if (!is_cut_face(mesh, f) && loses_odd_number(f)) odd.push_back(f);
                    });
            is_done = odd.empty();
            for (const FaceId f : odd) need_all(f);
        }
    std::vector<VertexId> finished;
    for (const auto& entry : nodes_)
        if (!needed.contains(entry.first)) finished.push_back(entry.first);
    for (const VertexId n : finished) nodes_.erase(n);
    for (const VertexId n : finished) forget(n);
    // Other cuts divide marked edges by nodes that are not on this one.
    for (auto& [n, others] : marked_)
        if (!is_on(n)) std::erase_if(others, [&](VertexId other) { return !is_on(other); });
    std::erase_if(marked_, [](const auto& entry) { return entry.second.empty(); });
}

}  // namespace incise::cutting
