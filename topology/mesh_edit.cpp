// SPDX-License-Identifier: LGPL-3.0-or-later
#include "topology/mesh_edit.h"

#include <algorithm>
#include <cassert>

#include "topology/error.h"

namespace incise::topology {

MeshEdit::MeshEdit(Mesh& mesh) : mesh_(mesh), is_saved_(mesh.element_capacity(), 0) {}

MeshEdit::~MeshEdit() {
    if (!is_open_ || saved_.empty()) return;
    ChangeSet changes = differences();
    changes.epoch_before = changes.epoch_after = mesh_.epoch();
    replay(mesh_, inverse(changes));
}

void MeshEdit::require_alive(ElementId e) const {
    if (!e.is_valid() || e.index() >= mesh_.element_capacity() || !mesh_.is_alive(e))
        throw InputError("edit: element " + std::to_string(e.value) + " does not exist");
}

void MeshEdit::save(ElementId e) {
    if (is_saved_[e.index()]) return;
    is_saved_[e.index()] = 1;
    const auto corners = mesh_.corners(e);
    SavedRow row{e, mesh_.is_alive(e), {corners.begin(), corners.end()}, {}};
    for (int f = 0; f < mesh_.num_faces(e); ++f) row.neighbors.push_back(mesh_.neighbor({e, f}));
    saved_.push_back(std::move(row));
}

void MeshEdit::touch_face(FaceId f) {
    for (int p = 0; p < mesh_.face_size(f); ++p)
        touched_.push_back({mesh_.face_corner(f, p), f.element});
}

void MeshEdit::part(FaceId f) {
    const FaceId other = mesh_.neighbor(f);
    save(f.element);
    save(other.element);
    touch_face(f);
    touch_face(other);
    mesh_.unglue(f);
}

void MeshEdit::remove(ElementId e) {
    require_alive(e);
    save(e);
    for (int f = 0; f < mesh_.num_faces(e); ++f)
        if (mesh_.neighbor({e, f}).is_valid()) part({e, f});
    for (const NodeId n : mesh_.corners(e)) touched_.push_back({n, ElementId()});
    mesh_.map_.remove_element(e);
    mesh_.alive_[e.index()] = 0;
    --mesh_.num_elements_;
}

void MeshEdit::open(FaceId f) {
    require_alive(f.element);
    if (!mesh_.neighbor(f).is_valid())
        throw InputError("edit: face " + std::to_string(f.face) + " of element " +
                         std::to_string(f.element.value) + " is on the boundary already");
    part(f);
}

void MeshEdit::close(FaceId a, FaceId b) {
    require_alive(a.element);
    require_alive(b.element);
    const auto refuse = [&](const char* why) {
        throw InputError("edit: face " + std::to_string(a.face) + " of element " +
                         std::to_string(a.element.value) + " and face " + std::to_string(b.face) +
                         " of element " + std::to_string(b.element.value) +
                         " cannot be joined: " + why);
    };
    if (a.element == b.element) refuse("they belong to one element");
    if (mesh_.neighbor(a).is_valid() || mesh_.neighbor(b).is_valid())
        refuse("one of them is joined already");
    const int size = mesh_.face_size(a);
    if (mesh_.face_size(b) != size) refuse("they differ in their number of corners");

    // At rest the corners of the two sides coincide: that tells how they meet.
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

    save(a.element);
    save(b.element);
    for (int p = 0; p < size; ++p) {
        const NodeId n = mesh_.face_corner(a, p);
        const NodeId m = mesh_.face_corner(b, (shift - p + size) % size);
        if (n == m) continue;
        if (n < m)
            merge(n, m, b.element);
        else
            merge(m, n, a.element);
    }
    mesh_.glue(a, b, shift);
    touch_face(a);
    touch_face(b);
}

void MeshEdit::rewire(ElementId e, int corner, NodeId to) {
    save(e);
    mesh_.map_.set_corner(e, corner, to, mesh_.rest_position(to));
    mesh_.corners_[mesh_.corner_begin_[e.index()] + static_cast<std::size_t>(corner)] = to;
}

void MeshEdit::merge(NodeId survivor, NodeId absorbed, ElementId at) {
    // The absorbed node may already hang together in parts only: start from each that is known.
    std::vector<ElementId> starts{at};
    if (mesh_.is_alive(absorbed)) starts.push_back(mesh_.anchor(absorbed));
    for (const TouchedCorner& touched : touched_)
        if (touched.node == absorbed) starts.push_back(touched.element);
    for (const ElementId start : starts) {
        if (!start.is_valid() || !mesh_.is_alive(start)) continue;
        if (mesh_.corner_of(start, absorbed) < 0) continue;
        std::vector<ElementId> holders;
        collect_star(mesh_, absorbed, start, holders);
        for (const ElementId e : holders) {
            rewire(e, mesh_.corner_of(e, absorbed), survivor);
            touched_.push_back({survivor, e});
        }
    }
    touched_.push_back({absorbed, ElementId()});
    merged_.emplace_back(absorbed, survivor);
}

NodeId MeshEdit::survivor_of(NodeId n) const {
    // A survivor may have been absorbed later on, always by a lower node.
    for (std::size_t i = 0; i < merged_.size(); ++i)
        if (merged_[i].first == n) return survivor_of(merged_[i].second);
    return n;
}

void MeshEdit::settle_node(NodeId n, const std::vector<ElementId>& candidates, ChangeSet& changes) {
    std::vector<std::vector<ElementId>> parts;
    for (const ElementId e : candidates) {
        if (!e.is_valid() || !mesh_.is_alive(e) || mesh_.corner_of(e, n) < 0) continue;
        const bool is_known = std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
            return std::binary_search(part.begin(), part.end(), e);
        });
        if (is_known) continue;
        parts.emplace_back();
        collect_star(mesh_, n, e, parts.back());
    }
    std::sort(parts.begin(), parts.end());

    if (parts.empty()) {
        NodeRecord record{n, mesh_.rest_position(n), {}, 0};
        if (const NodeId survivor = survivor_of(n); survivor != n) {
            record.sources[0] = {survivor, 1.0};
            record.num_sources = 1;
        }
        changes.nodes_removed.push_back(record);
        mesh_.anchors_[n.index()] = {};
        --mesh_.num_nodes_;
        return;
    }
    for (std::size_t p = 0; p < parts.size(); ++p) {
        NodeId keeper = n;
        if (p > 0) {
            keeper = NodeId(mesh_.node_capacity());
            NodeRecord record{keeper, mesh_.rest_position(n), {}, 1};
            record.sources[0] = {n, 1.0};
            changes.nodes_added.push_back(record);
            mesh_.rest_positions_.push_back(record.rest_position);
            mesh_.anchors_.emplace_back();
            ++mesh_.num_nodes_;
            for (const ElementId e : parts[p]) rewire(e, mesh_.corner_of(e, n), keeper);
        }
        const ElementId anchor = parts[p].front();
        mesh_.anchors_[keeper.index()] = anchor;
        mesh_.map_.set_anchor(keeper, anchor, mesh_.corner_of(anchor, keeper));
    }
}

void MeshEdit::divide_nodes(ChangeSet& changes) {
    std::sort(touched_.begin(), touched_.end());
    touched_.erase(std::unique(touched_.begin(), touched_.end()), touched_.end());
    std::vector<ElementId> candidates;
    for (std::size_t i = 0; i < touched_.size();) {
        const NodeId n = touched_[i].node;
        candidates.clear();
        for (; i < touched_.size() && touched_[i].node == n; ++i)
            candidates.push_back(touched_[i].element);
        settle_node(n, candidates, changes);
    }
}

ChangeSet MeshEdit::differences() const {
    ChangeSet changes;
    changes.node_capacity_before = changes.node_capacity_after = mesh_.node_capacity();
    changes.element_capacity_before = changes.element_capacity_after = mesh_.element_capacity();

    std::vector<const SavedRow*> rows;
    for (const SavedRow& row : saved_) rows.push_back(&row);
    std::sort(rows.begin(), rows.end(),
              [](const SavedRow* a, const SavedRow* b) { return a->element < b->element; });
    for (const SavedRow* row : rows) {
        const ElementId e = row->element;
        const bool is_alive = mesh_.is_alive(e);
        if (row->was_alive && !is_alive)
            changes.elements_removed.push_back(
                {e, mesh_.kind(e), mesh_.region(e), {}, row->corners});
        if (row->was_alive && is_alive)
            for (std::size_t k = 0; k < row->corners.size(); ++k)
                if (row->corners[k] != mesh_.corners(e)[k])
                    changes.rewired.push_back(
                        {e, static_cast<int>(k), row->corners[k], mesh_.corners(e)[k]});
        for (int f = 0; f < mesh_.num_faces(e); ++f) {
            const FaceId face{e, f};
            const FaceId before = row->neighbors[static_cast<std::size_t>(f)];
            const FaceId now = is_alive ? mesh_.neighbor(face) : FaceId{};
            if (before == now) continue;
            if (before.is_valid() && face < before) changes.faces_opened.push_back({face, before});
            if (now.is_valid() && face < now) changes.faces_closed.push_back({face, now});
        }
    }
    std::sort(changes.faces_opened.begin(), changes.faces_opened.end());
    std::sort(changes.faces_closed.begin(), changes.faces_closed.end());
    return changes;
}

ChangeSet MeshEdit::commit() {
    assert(is_open_);
    const std::size_t node_capacity = mesh_.node_capacity();
    ChangeSet nodes;
    divide_nodes(nodes);
    ChangeSet changes = differences();
    is_open_ = false;
    changes.nodes_added = std::move(nodes.nodes_added);
    changes.nodes_removed = std::move(nodes.nodes_removed);
    changes.node_capacity_before = node_capacity;
    changes.epoch_before = mesh_.epoch();
    changes.epoch_after = changes.epoch_before + (changes.is_empty() ? 0 : 1);
    mesh_.epoch_ = changes.epoch_after;
    return changes;
}

}  // namespace incise::topology
