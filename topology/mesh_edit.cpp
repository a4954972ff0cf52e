// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/mesh_edit.h"

#include <algorithm>
#include <array>
#include <cassert>

#include "incise/base/error.h"

namespace incise::topology {

namespace {

/// By corner of a tetrahedron, the face that does not contain it.
constexpr std::array<int, 4> opposite_face = [] {
    std::array<int, 4> faces{};
    for (int f = 0; f < 4; ++f) {
        int corner = 0 + 1 + 2 + 3;
        for (const int c : traits(CellKind::tetrahedron).face(f)) corner -= c;
        faces[static_cast<std::size_t>(corner)] = f;
    }
    return faces;
}();

int face_opposite(int corner) { return opposite_face[static_cast<std::size_t>(corner)]; }

}  // namespace

MeshEdit::MeshEdit(Mesh& mesh)
    : mesh_(mesh),
      node_capacity_before_(mesh.node_capacity()),
      element_capacity_before_(mesh.element_capacity()) {}

MeshEdit::~MeshEdit() {
    if (!is_open_ || (saved_.empty() && parents_.empty())) return;
    ChangeSet changes = differences();
    changes.epoch_before = changes.epoch_after = mesh_.epoch();
    replay(mesh_, inverse(changes));
}

void MeshEdit::require_alive(CellId e) const {
    if (!e.is_valid() || e.index() >= mesh_.element_capacity() || !mesh_.is_alive(e))
        throw InputError("edit: element " + std::to_string(e.value) + " does not exist");
}

void MeshEdit::require_older(CellId e, const char* what) const {
    if (e.index() >= element_capacity_before_)
        throw InputError("edit: element " + std::to_string(e.value) +
                         " was made in this edit and cannot be " + what + " in it: commit first");
}

void MeshEdit::save(CellId e) {
    if (e.index() >= element_capacity_before_ || !is_saved_.insert(e).second) return;
    SavedRow row{e, mesh_.is_alive(e), mesh_.kind(e), {}, {}, mesh_.inside_faces_[e.index()], {},
                 {}};
    std::ranges::copy(mesh_.row(e), row.corners.begin());
    if (mesh_.is_polyhedron(e)) {
        row.neighbors_of_polyhedron = mesh_.polyhedron(e).neighbors;
        row.shape = mesh_.polyhedron(e).shape;
    } else {
        for (int f = 0; f < mesh_.num_faces(e); ++f)
            row.neighbors[static_cast<std::size_t>(f)] = mesh_.neighbor({e, f});
    }
    saved_.push_back(std::move(row));
}

void MeshEdit::touch_face(FaceId f) {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        touched_.push_back({mesh_.face_corner(f, p), f.cell});
}

void MeshEdit::part(FaceId f) {
    const FaceId other = mesh_.neighbor(f);
    save(f.cell);
    save(other.cell);
    touch_face(f);
    touch_face(other);
    mesh_.unglue(f);
}

void MeshEdit::remove(CellId e) {
    require_alive(e);
    require_older(e, "removed");
    save(e);
    for (int f = 0; f < mesh_.num_faces(e); ++f) {
        const FaceId other = mesh_.neighbor({e, f});
        if (!other.is_valid()) continue;
        save(other.cell);
        touch_face(other);
        mesh_.unglue(other);
    }
    for (const VertexId n : mesh_.corners(e)) touched_.push_back({n, CellId()});
    mesh_.alive_[e.index()] = 0;
    --mesh_.num_elements_;
}

void MeshEdit::open(FaceId f) {
    require_alive(f.cell);
    if (!mesh_.neighbor(f).is_valid())
        throw InputError("edit: face " + std::to_string(f.face) + " of element " +
                         std::to_string(f.cell.value) + " is on the boundary already");
    part(f);
}

void MeshEdit::close(FaceId a, FaceId b) {
    require_alive(a.cell);
    require_alive(b.cell);
    require_older(a.cell, "joined");
    require_older(b.cell, "joined");
    const auto refuse = [&](const char* why) {
        throw InputError("edit: face " + std::to_string(a.face) + " of element " +
                         std::to_string(a.cell.value) + " and face " + std::to_string(b.face) +
                         " of element " + std::to_string(b.cell.value) +
                         " cannot be joined: " + why);
    };
    if (a.cell == b.cell) refuse("they belong to one element");
    if (mesh_.neighbor(a).is_valid() || mesh_.neighbor(b).is_valid())
        refuse("one of them is joined already");
    const int size = mesh_.face_size(a);
    if (mesh_.face_size(b) != size) refuse("they differ in their number of corners");

    // The corners of the two faces coincide at rest, which determines the shift.
    const auto fits = [&](int shift) {
        for (int p = 0; p < size; ++p)
            if (mesh_.rest_position(mesh_.face_corner(a, p)) !=
                mesh_.rest_position(mesh_.face_corner(b, (shift - p + size) % size)))
                return false;
        return true;
    };
    int shift = 0;
    while (shift < size && !fits(shift)) ++shift;
    if (shift == size) refuse("their corners do not lie at the same rest positions");

    save(a.cell);
    save(b.cell);
    for (int p = 0; p < size; ++p) {
        const VertexId n = mesh_.face_corner(a, p);
        const VertexId m = mesh_.face_corner(b, (shift - p + size) % size);
        if (n == m) continue;
        if (n < m)
            merge(n, m, b.cell);
        else
            merge(m, n, a.cell);
    }
    mesh_.glue(a, b);
    touch_face(a);
    touch_face(b);
}

void MeshEdit::rewire(CellId e, VertexId from, VertexId to) {
    save(e);
    if (mesh_.is_polyhedron(e)) {
        Mesh::Polyhedron& cell = mesh_.polyhedra_.at(e);
        cell.shape.replace_corner(from, to);
        std::ranges::replace(cell.corners, from, to);
        return;
    }
    const auto corner = static_cast<std::size_t>(mesh_.corner_of(e, from));
    mesh_.corners_[mesh_.corner_begin_[e.index()] + corner] = to;
}

// Collects the elements at the edge in cyclic order. If the ring is not closed, it consists of
// arcs, which are collected one after the other. Returns false if an element is no tetrahedron.
bool MeshEdit::collect_ring(CellId e, VertexId a, VertexId b) {
    ring_.clear();
    const auto enter = [&](CellId element, int through) {
        RingElement at{element, mesh_.corner_of(element, a), mesh_.corner_of(element, b), -1};
        // The search leaves the element by the face at the edge through which it has not entered.
        for (int f = 0; f < 4; ++f)
            if (f != face_opposite(at.corner_a) && f != face_opposite(at.corner_b) && f != through)
                at.next_face = f;
        return at;
    };
    const auto next = [&](const RingElement& at) {
        const FaceId to = mesh_.neighbor({at.element, at.next_face});
        return to.is_valid() ? enter(to.cell, to.face) : RingElement{};
    };
    const auto is_tetrahedron = [&](CellId element) {
        return mesh_.kind(element) == CellKind::tetrahedron;
    };
    const auto add_arc = [&](CellId start) {
        // Go to the first element of the arc, or once round a closed ring.
        RingElement first = enter(start, -1);
        for (;;) {
            const FaceId to = mesh_.neighbor({first.element, first.next_face});
            if (!to.is_valid() || to.cell == start) break;
            if (!is_tetrahedron(to.cell)) return false;
            first = enter(to.cell, to.face);
        }
        // Reverse the direction of the search.
        first = enter(first.element, first.next_face);
        for (RingElement at = first;;) {
            ring_.push_back(at);
            at = next(at);
            if (!at.element.is_valid()) return true;
            if (at.element == first.element) return true;
            if (!is_tetrahedron(at.element)) return false;
        }
    };
    if (!is_tetrahedron(e) || !add_arc(e)) return false;
    if (mesh_.neighbor({ring_.back().element, ring_.back().next_face}).is_valid()) return true;
    // The edge is on the boundary. Further arcs may be connected with this one only through faces
    // at one end of the edge.
    star_.clear();
    collect_star(mesh_, a, e, star_);
    for (const CellId other : star_) {
        const bool is_known = std::any_of(
            ring_.begin(), ring_.end(), [&](const RingElement& at) { return at.element == other; });
        if (is_known || mesh_.corner_of(other, b) < 0) continue;
        if (!is_tetrahedron(other) || !add_arc(other)) return false;
    }
    return true;
}

VertexId MeshEdit::add_node(const VertexRecord& record) {
    nodes_added_.push_back(record);
    mesh_.rest_positions_.push_back(record.rest_position);
    mesh_.incident_elements_.emplace_back();
    ++mesh_.num_nodes_;
    return record.id;
}

VertexId MeshEdit::add_node_between(VertexId a, VertexId b, double t) {
    VertexRecord record{VertexId(mesh_.node_capacity()),
                        (1.0 - t) * mesh_.rest_position(a) + t * mesh_.rest_position(b),
                        {},
                        2};
    record.sources[0] = {a, 1.0 - t};
    record.sources[1] = {b, t};
    return add_node(record);
}

CellId MeshEdit::divide(const RingElement& at, VertexId middle) {
    const CellId kept = at.element, added(mesh_.element_capacity());
    const auto corner_a = static_cast<std::size_t>(at.corner_a);
    const int inner_face = face_opposite(at.corner_a), cut_face = face_opposite(at.corner_b);
    const FaceId outer = mesh_.neighbor({kept, inner_face});
    save(kept);
    if (outer.is_valid()) {
        save(outer.cell);
        mesh_.unglue({kept, inner_face});
    }
    const auto old = mesh_.corners(kept);
    std::array<VertexId, 4> corners{old[0], old[1], old[2], old[3]};
    const VertexId b = corners[static_cast<std::size_t>(at.corner_b)];
    corners[corner_a] = middle;
    rewire(kept, b, middle);
    mesh_.append_element_row(CellKind::tetrahedron, mesh_.region(kept), corners);
    // Each half of a divided face takes its value, and the face that goes to the added half whole
    // keeps its own. The new face between the halves is inside, as it is joined below.
    mesh_.inside_faces_[added.index()] = mesh_.inside_faces_[kept.index()];
    parents_.push_back(kept);

    mesh_.glue({kept, inner_face}, {added, cut_face});
    if (outer.is_valid()) mesh_.glue({added, inner_face}, outer);
    // At the other corners the lowest element does not change.
    touched_.push_back({b, added});
    touched_.push_back({middle, kept});
    return added;
}

const MeshEdit::Bisection& MeshEdit::bisect(CellId e, VertexId a, VertexId b, double t) {
    require_alive(e);
    const auto refuse = [&](const std::string& why) {
        throw InputError("edit: the edge between nodes " + std::to_string(a.value) + " and " +
                         std::to_string(b.value) + " of element " + std::to_string(e.value) +
                         " cannot be divided: " + why);
    };
    if (a == b || mesh_.corner_of(e, a) < 0 || mesh_.corner_of(e, b) < 0)
        refuse("the element has no such edge");
    if (!(t > 0.0 && t < 1.0)) refuse("the place " + std::to_string(t) + " is not between 0 and 1");
    if (!collect_ring(e, a, b)) refuse("an element at it is no tetrahedron");

    bisection_.node = add_node_between(a, b, t);
    bisection_.elements.clear();
    for (const RingElement& at : ring_)
        bisection_.elements.push_back({at.element, divide(at, bisection_.node)});
    // The kept halves are still joined to each other. The added halves are joined in the same way.
    for (std::size_t i = 0; i < ring_.size(); ++i) {
        const FaceId face{ring_[i].element, ring_[i].next_face}, other = mesh_.neighbor(face);
        if (!other.is_valid()) continue;
        // The neighbour is the next element in the list, except where a ring closes.
        std::size_t next = i + 1;
        if (next == ring_.size() || ring_[next].element != other.cell) next = 0;
        while (ring_[next].element != other.cell) ++next;
        const FaceId one{bisection_.elements[i].added, face.face};
        const FaceId two{bisection_.elements[next].added, other.face};
        mesh_.glue(one, two);
    }
    return bisection_;
}

void MeshEdit::merge(VertexId survivor, VertexId absorbed, CellId at) {
    // The elements of the absorbed node may no longer be connected: search from all that are known.
    std::vector<CellId> starts{at};
    if (mesh_.is_alive(absorbed)) starts.push_back(mesh_.incident_element(absorbed));
    for (const TouchedCorner& touched : touched_)
        if (touched.node == absorbed) starts.push_back(touched.element);
    for (const CellId start : starts) {
        if (!start.is_valid() || !mesh_.is_alive(start)) continue;
        if (mesh_.corner_of(start, absorbed) < 0) continue;
        std::vector<CellId> holders;
        collect_star(mesh_, absorbed, start, holders);
        for (const CellId e : holders) {
            rewire(e, absorbed, survivor);
            touched_.push_back({survivor, e});
        }
    }
    touched_.push_back({absorbed, CellId()});
    merged_.emplace_back(absorbed, survivor);
}

VertexId MeshEdit::survivor_of(VertexId n) const {
    // A survivor may itself have been absorbed later, always by a node with a lower id.
    for (const auto& [absorbed, survivor] : merged_)
        if (absorbed == n) return survivor_of(survivor);
    return n;
}

void MeshEdit::split_star(VertexId n, const std::vector<CellId>& candidates,
                          std::vector<VertexRecord>& removed) {
    std::vector<std::vector<CellId>> parts;
    for (const CellId e : candidates) {
        if (!e.is_valid() || !mesh_.is_alive(e) || mesh_.corner_of(e, n) < 0) continue;
        const bool is_known = std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
            return std::binary_search(part.begin(), part.end(), e);
        });
        if (is_known) continue;
        star_.clear();
        collect_star(mesh_, n, e, star_);
        parts.push_back(star_);
    }
    std::sort(parts.begin(), parts.end());

    if (parts.empty()) {
        VertexRecord record{n, mesh_.rest_position(n), {}, 0};
        if (const VertexId survivor = survivor_of(n); survivor != n) {
            record.sources[0] = {survivor, 1.0};
            record.num_sources = 1;
        }
        removed.push_back(record);
        mesh_.incident_elements_[n.index()] = {};
        --mesh_.num_nodes_;
        return;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        VertexId keeper = n;
        if (p > 0) {
            VertexRecord record{VertexId(mesh_.node_capacity()), mesh_.rest_position(n), {}, 1};
            record.sources[0] = {n, 1.0};
            keeper = add_node(record);
            for (const CellId e : parts[p]) rewire(e, n, keeper);
        }
        mesh_.incident_elements_[keeper.index()] = parts[p].front();
    }
}

void MeshEdit::divide_nodes(std::vector<VertexRecord>& removed) {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    std::vector<CellId> candidates;
    for (std::size_t i = 0; i < touched_.size();) {
        const VertexId n = touched_[i].node;
        candidates.clear();
        for (; i < touched_.size() && touched_[i].node == n; ++i)
            candidates.push_back(touched_[i].element);
        split_star(n, candidates, removed);
    }
}

ChangeSet MeshEdit::differences() const {
    ChangeSet changes;
    changes.node_capacity_before = node_capacity_before_;
    changes.node_capacity_after = mesh_.node_capacity();
    changes.element_capacity_before = element_capacity_before_;
    changes.element_capacity_after = mesh_.element_capacity();
    changes.nodes_added = nodes_added_;

    std::vector<const SavedRow*> rows;
    for (const SavedRow& row : saved_) rows.push_back(&row);
    std::sort(rows.begin(), rows.end(),
              [](const SavedRow* a, const SavedRow* b) { return a->element < b->element; });
    const auto add_pairs = [&](FaceId face, FaceId before, FaceId now) {
        if (before == now) return;
        if (before.is_valid() && face < before) changes.faces_opened.push_back({face, before});
        if (now.is_valid() && face < now) changes.faces_closed.push_back({face, now});
    };
    for (const SavedRow* row : rows) {
        const CellId e = row->element;
        const bool is_alive = mesh_.is_alive(e);
        const auto corners = mesh_.row(e);
        const std::span old_corners(row->corners.data(), corners.size());
        if (row->was_alive && !is_alive) {
            CellRecord& record = changes.elements_removed.emplace_back(
                CellRecord{e, row->kind, mesh_.region(e), {}, {}});
            if (row->kind == CellKind::polyhedron)
                row->shape.append_corners(record.corners);
            else
                record.corners.assign(old_corners.begin(), old_corners.end());
        }
        if (row->was_alive && is_alive)
            for (std::size_t k = 0; k < corners.size(); ++k)
                if (old_corners[k] != corners[k])
                    changes.rewired.push_back({e, static_cast<int>(k), old_corners[k], corners[k]});
        const bool is_polyhedron = mesh_.is_polyhedron(e);
        if (row->kind != mesh_.kind(e) ||
            (is_polyhedron && row->shape != mesh_.polyhedron(e).shape))
            changes.shape_changes.push_back(
                {e, row->kind, mesh_.kind(e), row->shape,
                 is_polyhedron ? mesh_.polyhedron(e).shape : CellShape{}});
        if (const std::uint8_t inside = mesh_.inside_faces_[e.index()]; inside != row->inside_faces)
            changes.inside_changes.push_back({e, row->inside_faces, inside});
        const int count_before = row->num_faces(), count = mesh_.num_faces(e);
        for (int f = 0; f < std::max(count_before, count); ++f)
            add_pairs({e, f}, f < count_before ? row->neighbor(f) : FaceId{},
                      is_alive && f < count ? mesh_.neighbor({e, f}) : FaceId{});
    }
    for (std::size_t i = element_capacity_before_; i < mesh_.element_capacity(); ++i) {
        const CellId e(i);
        const auto corners = mesh_.corners(e);
        changes.elements_added.push_back({e,
                                          mesh_.kind(e),
                                          mesh_.region(e),
                                          parents_[i - element_capacity_before_],
                                          {corners.begin(), corners.end()}});
        if (mesh_.is_polyhedron(e))
            changes.shape_changes.push_back(
                {e, CellKind::polyhedron, CellKind::polyhedron, {}, mesh_.polyhedron(e).shape});
        else
            changes.inside_changes.push_back({e, 0, mesh_.inside_faces_[i]});
        for (int f = 0; f < mesh_.num_faces(e); ++f) add_pairs({e, f}, {}, mesh_.neighbor({e, f}));
    }
    std::sort(changes.faces_opened.begin(), changes.faces_opened.end());
    std::sort(changes.faces_closed.begin(), changes.faces_closed.end());
    return changes;
}

ChangeSet MeshEdit::commit() {
    assert(is_open_);
    std::vector<VertexRecord> nodes_removed;
    divide_nodes(nodes_removed);
    ChangeSet changes = differences();
    is_open_ = false;
    changes.nodes_removed = std::move(nodes_removed);
    changes.epoch_before = changes.epoch_after = mesh_.epoch();
    if (!changes.is_empty()) ++changes.epoch_after;
    mesh_.epoch_ = changes.epoch_after;
    return changes;
}

}  // namespace incise::topology
