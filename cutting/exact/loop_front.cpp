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

bool has_corner(const Mesh& mesh, FaceId f, VertexId n) {
    for (int p = 0; p < mesh.face_size(f); ++p)
        if (mesh.face_corner(f, p) == n) return true;
    return false;
}

}  // namespace

void LoopFront::mark(VertexId a, VertexId b) {
    if (is_marked(a, b)) return;
    insert_sorted(marked_[a], b);
    insert_sorted(marked_[b], a);
}

VertexId LoopFront::passed_at(VertexId a, VertexId b) const {
    const auto it = passed_.find(edge_between(a, b));
    return it != passed_.end() ? it->second : VertexId();
}

void LoopFront::toggle_passed(const EdgeAt& edge) {
    const auto [it, is_new] = passed_.emplace(edge_between(edge.node, edge.end), edge.node);
    if (!is_new) passed_.erase(it);
}

const LoopFront::FaceState& LoopFront::state(FaceId f) const {
    static const FaceState none;
    const auto of_cell = faces_.find(f.cell);
    if (of_cell == faces_.end()) return none;
    const auto it = of_cell->second.find(f.face);
    return it != of_cell->second.end() ? it->second : none;
}

void LoopFront::forget_if_empty(FaceId f) {
    const auto of_cell = faces_.find(f.cell);
    if (of_cell == faces_.end() || !state(f).is_empty()) return;
    of_cell->second.erase(f.face);
    if (of_cell->second.empty()) faces_.erase(of_cell);
}

void LoopFront::set_waiting(const Mesh& mesh, FaceId f, VertexId n, bool is_to_wait) {
    if (waits(f, n) == is_to_wait) return;
    for (const FaceId side : {f, mesh.neighbor(f)}) {
        if (!side.is_valid()) continue;
        std::vector<VertexId>& waiting = state_of(side).waiting;
        if (is_to_wait)
            insert_sorted(waiting, n);
        else
            std::erase(waiting, n);
        forget_if_empty(side);
    }
}

void LoopFront::set_on_cut(const Mesh& mesh, FaceId f, bool is_on_cut, bool was_there) {
    for (const FaceId side : {f, mesh.neighbor(f)}) {
        if (!side.is_valid()) continue;
        FaceState& state = state_of(side);
        state.is_on_cut = is_on_cut;
        state.was_there = is_on_cut && was_there;
        forget_if_empty(side);
    }
}

bool LoopFront::waits_again(const Mesh& mesh, FaceId f, VertexId n) const {
    if (is_through(n) || !waits(f, n)) return false;
    const int size = mesh.face_size(f);
    for (int p = 0; p < size; ++p)
        if (mesh.face_corner(f, p) == n)
            return is_marked(n, mesh.face_corner(f, (p + 1) % size)) ||
                   is_marked(n, mesh.face_corner(f, (p + size - 1) % size));
    return false;
}

LoopFront::FaceState LoopFront::take(const Mesh& mesh, FaceId f) {
    FaceState taken = state(f);
    if (taken.is_empty()) return taken;
    for (const FaceId side : {f, mesh.neighbor(f)}) {
        if (!side.is_valid()) continue;
        state_of(side) = {};
        forget_if_empty(side);
    }
    return taken;
}

void LoopFront::put(const Mesh& mesh, FaceId part, const FaceState& whole) {
    if (whole.is_on_cut) set_on_cut(mesh, part, true, whole.was_there);
    for (const VertexId n : whole.waiting)
        if (has_corner(mesh, part, n)) set_waiting(mesh, part, n, true);
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

void LoopFront::divide(const Mesh& mesh, CellId kept, CellId added, std::span<const FaceId> faces) {
    if (const auto it = faces_.find(kept); it != faces_.end()) {
        const auto before = std::move(it->second);
        faces_.erase(it);
        for (const auto& [k, state] : before) state_of(faces[static_cast<std::size_t>(k)]) = state;
    }
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
    const Edge whole = edge_between(a, b);
    for (auto* edges : {&crossed_, &passed_})
        if (const auto it = edges->find(whole); it != edges->end()) {
            const VertexId node = it->second;
            edges->erase(it);
            edges->emplace(edge_between(node, middle), node);
        }
    if (!lies_on(a, b)) return;
    if (along_.erase(whole) > 0) {
        set_along(a, middle);
        set_along(middle, b);
    }
    if (is_marked(a, b)) {
        std::erase(marked_[a], b);
        std::erase(marked_[b], a);
        mark(a, middle);
        mark(middle, b);
    }
    for (auto& [e, edges] : open_) {
        const auto it = std::ranges::find(edges, whole);
        if (it == edges.end()) continue;
        *it = edge_between(a, middle);
        edges.push_back(edge_between(middle, b));
        put_on(middle, local_edge_length);
    }
}

bool LoopFront::add(const LoopFront& other) {
    for (const auto& [n, node] : other.nodes_)
        if (is_on(n) && !(node.is_through && is_through(n))) return false;
    for (const auto& [n, node] : other.nodes_)
        nodes_.try_emplace(n, Node{node.local_edge_length, node.is_through, true});
    for (const auto& [a, ends] : other.marked_)
        for (const VertexId b : ends) mark(a, b);
    along_.insert(other.along_.begin(), other.along_.end());
    crossed_.insert(other.crossed_.begin(), other.crossed_.end());
    for (const auto& [edge, node] : other.passed_)  // one that both have passed is not passed
        toggle_passed({node, node == edge.a ? edge.b : edge.a});
    for (const auto& [e, faces] : other.faces_)  // likewise a node that waits for both
        for (const auto& [k, state] : faces) {
            FaceState& mine = state_of({e, k});
            mine.was_there = mine.was_there || state.was_there;
            mine.is_on_cut = mine.is_on_cut || state.is_on_cut;
            for (const VertexId n : state.waiting)
                if (std::erase(mine.waiting, n) == 0) insert_sorted(mine.waiting, n);
            forget_if_empty({e, k});
        }
    for (const auto& [e, edges] : other.open_) {
        for (const Edge& edge : edges)
            if (std::vector<Edge>& mine = open_[e]; std::erase(mine, edge) == 0)
                mine.push_back(edge);
        if (open_[e].empty()) open_.erase(e);
    }
    return true;
}

bool LoopFront::is_on(const Mesh& mesh) const {
    const auto is_there = [&](VertexId n) { return n.index() < mesh.node_capacity(); };
    const auto is_alive = [&](CellId e) {
        return e.index() < mesh.element_capacity() && mesh.is_alive(e);
    };
    const auto all_of = [](const auto& map, auto test) {
        return std::ranges::all_of(
            map, [&](const auto& entry) { return test(entry.first, entry.second); });
    };
    const auto is_edge_at = [&](const Edge& edge, VertexId node) {
        return is_there(edge.a) && is_there(edge.b) && (node == edge.a || node == edge.b);
    };
    return all_of(nodes_, [&](VertexId n, const Node&) { return is_there(n); }) &&
           all_of(marked_,
                  [&](VertexId n, const std::vector<VertexId>& others) {
                      return is_there(n) && std::ranges::all_of(others, is_there);
                  }) &&
           all_of(along_,
                  [&](const Edge& edge, bool) { return is_there(edge.a) && is_there(edge.b); }) &&
           all_of(crossed_, is_edge_at) && all_of(passed_, is_edge_at) &&
           all_of(faces_,
                  [&](CellId e, const auto& faces) {
                      return is_alive(e) && all_of(faces, [&](int k, const FaceState& state) {
                                 return k >= 0 && k < mesh.num_faces(e) &&
                                        std::ranges::all_of(state.waiting, [&](VertexId n) {
                                            return has_corner(mesh, {e, k}, n);
                                        });
                             });
                  }) &&
           all_of(open_, [&](CellId e, const std::vector<Edge>& edges) {
               return is_alive(e) && std::ranges::all_of(edges, [&](const Edge& edge) {
                          return find_dart(mesh, e, edge.a, edge.b).is_valid();
                      });
           });
}

void LoopFront::keep_nodes_only() {
    marked_.clear();
    along_.clear();
    crossed_.clear();
    passed_.clear();
    faces_.clear();
    open_.clear();
}

/// Forgets what is at nodes that are not on the cut any more. Marked edges stay that have one end
/// on the cut.
void LoopFront::forget_what_is_off(const Mesh& mesh) {
    for (auto& [n, others] : marked_)
        if (!is_on(n)) std::erase_if(others, [&](VertexId other) { return !is_on(other); });
    std::erase_if(marked_, [](const auto& entry) { return entry.second.empty(); });
    std::erase_if(
        along_, [&](const auto& entry) { return !is_on(entry.first.a) && !is_on(entry.first.b); });
    for (auto* edges : {&crossed_, &passed_})
        std::erase_if(*edges, [&](const auto& entry) { return !is_on(entry.second); });
    for (auto& [e, faces] : faces_) {
        for (auto& [k, state] : faces)
            std::erase_if(state.waiting, [&](VertexId n) { return !is_on(n); });
        std::erase_if(faces, [&](const auto& entry) {
            const FaceId f{e, entry.first};
            bool is_near = false;
            for (int p = 0; p < mesh.face_size(f); ++p)
                is_near = is_near || is_on(mesh.face_corner(f, p));
            return entry.second.is_empty() || !is_near;
        });
    }
    std::erase_if(faces_, [](const auto& entry) { return entry.second.empty(); });
}

void LoopFront::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (is_empty()) return;
    std::unordered_map<VertexId, std::vector<VertexId>> copies;
    for (const topology::VertexRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const VertexId source = record.sources[0].node;
        copies[source].push_back(record.id);
        if (const auto it = nodes_.find(source); it != nodes_.end()) {
            const Node node = it->second;
            nodes_.try_emplace(record.id, node);
        }
    }
    const auto all_of = [&](VertexId n) {
        std::vector<VertexId> all{n};
        if (const auto it = copies.find(n); it != copies.end())
            all.insert(all.end(), it->second.begin(), it->second.end());
        return all;
    };
    if (!copies.empty()) {
        std::vector<CellId> star;
        const auto has_edge = [&](VertexId a, VertexId b) {
            if (!mesh.is_alive(a) || !mesh.is_alive(b)) return false;
            mesh.star(a, star);
            return std::ranges::any_of(
                star, [&](CellId e) { return find_dart(mesh, e, a, b).is_valid(); });
        };
        const auto follow = [&](VertexId a, VertexId b, auto add) {
            if (!copies.contains(a) && !copies.contains(b)) {
                add(a, b);
                return;
            }
            for (const VertexId x : all_of(a))
                for (const VertexId y : all_of(b))
                    if (has_edge(x, y)) add(x, y);
        };
        const auto marked = std::exchange(marked_, {});
        for (const auto& [a, others] : marked)
            for (const VertexId b : others)
                if (a < b) follow(a, b, [&](VertexId x, VertexId y) { mark(x, y); });
        const auto along = std::exchange(along_, {});
        for (const auto& entry : along)
            follow(entry.first.a, entry.first.b, [&](VertexId x, VertexId y) { set_along(x, y); });
        for (auto* edges : {&crossed_, &passed_}) {
            const auto before = std::exchange(*edges, {});
            for (const auto& [edge, node] : before)
                follow(node, node == edge.a ? edge.b : edge.a,
                       [&](VertexId x, VertexId y) { (*edges)[edge_between(x, y)] = x; });
        }
        for (auto& [e, edges] : open_) {
            std::vector<Edge> now;
            for (const Edge& edge : edges)
                for (const VertexId x : all_of(edge.a))
                    for (const VertexId y : all_of(edge.b))
                        if (find_dart(mesh, e, x, y).is_valid()) now.push_back(edge_between(x, y));
            edges = std::move(now);
        }
    }
    for (const topology::CellRecord& record : changes.elements_removed) {
        open_.erase(record.id);
        faces_.erase(record.id);
    }
    for (auto& [e, faces] : faces_) {
        std::erase_if(faces, [&](const auto& entry) { return entry.first >= mesh.num_faces(e); });
        for (auto& [k, state] : faces) {
            std::vector<VertexId> now;
            for (const VertexId n : state.waiting)
                for (const VertexId x : all_of(n))
                    if (has_corner(mesh, {e, k}, x)) insert_sorted(now, x);
            state.waiting = std::move(now);
        }
    }
    if (changes.nodes_removed.empty()) return;
    const auto is_gone = [&](VertexId n) { return !mesh.is_alive(n); };
    for (const topology::VertexRecord& record : changes.nodes_removed) nodes_.erase(record.id);
    for (auto* edges : {&crossed_, &passed_})
        std::erase_if(*edges, [&](const auto& entry) {
            return is_gone(entry.first.a) || is_gone(entry.first.b);
        });
    std::erase_if(along_, [&](const auto& entry) {
        return is_gone(entry.first.a) || is_gone(entry.first.b);
    });
    for (auto& entry : open_)
        std::erase_if(entry.second, [&](const Edge& x) { return !is_on(x.a) || !is_on(x.b); });
    std::erase_if(open_, [](const auto& entry) { return entry.second.empty(); });
    forget_what_is_off(mesh);
}

void LoopFront::leave_behind(const Mesh& mesh) {
    std::unordered_set<VertexId> at_work;  // round which something waits or is open
    for (const auto& [e, edges] : open_)
        for (const Edge& edge : edges) at_work.insert({edge.a, edge.b});
    for (const auto& [e, faces] : faces_)
        for (const auto& [k, state] : faces)
            for (const VertexId n : state.waiting)
                if (!waits_again(mesh, {e, k}, n)) at_work.insert(n);
    std::unordered_set<VertexId> needed;
    const auto need = [&](VertexId n) {
        if (is_on(n)) needed.insert(n);
    };
    const auto need_all = [&](FaceId f) {
        for (int p = 0; p < mesh.face_size(f); ++p) need(mesh.face_corner(f, p));
    };
    std::vector<CellId> star;
    const auto for_faces_at = [&](VertexId n, auto visit) {
        mesh.star(n, star);
        for (const CellId e : star)
            for (int f = 0; f < mesh.num_faces(e); ++f)
                if (has_corner(mesh, {e, f}, n)) visit(FaceId{e, f});
    };
    for (const VertexId n : at_work) need(n);
    for (const VertexId n : at_work)
        for_faces_at(n, [&](FaceId f) {
            if (is_cut_face(f)) need_all(f);
        });
    // The cut comes into each face as often as it goes out, also without those that are forgotten.
    const auto is_left = [&](VertexId n) { return is_on(n) && !needed.contains(n); };
    const auto loses_odd_number = [&](FaceId f) {
        const int size = mesh.face_size(f);
        bool is_odd = false;
        for (int p = 0; p < size; ++p) {
            const VertexId n = mesh.face_corner(f, p), next = mesh.face_corner(f, (p + 1) % size);
            if (is_left(n)) is_odd ^= waits(f, n);
            if (is_left(n) || is_left(next)) is_odd ^= passed_at(n, next).is_valid();
        }
        return is_odd;
    };
    if (!passed_.empty() || !faces_.empty())
        for (bool is_done = false; !is_done;) {
            std::vector<FaceId> odd;  // all that are, so that the order of the nodes is nothing
            for (const auto& entry : nodes_)
                if (is_left(entry.first))
                    for_faces_at(entry.first, [&](FaceId f) {
                        if (!is_cut_face(f) && loses_odd_number(f)) odd.push_back(f);
                    });
            is_done = odd.empty();
            for (const FaceId f : odd) need_all(f);
        }
    std::erase_if(passed_, [&](const auto& entry) {
        return is_left(entry.first.a) || is_left(entry.first.b);
    });
    std::erase_if(nodes_, [&](const auto& entry) { return !needed.contains(entry.first); });
    forget_what_is_off(mesh);
}

}  // namespace incise::cutting
