// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/cell_set.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "incise/base/error.h"

namespace incise::physics {

using topology::CellRecord;
using topology::ChangeSet;
using topology::Mesh;
using topology::VertexRecord;

namespace {

template <class T>
void sort_and_make_unique(std::vector<T>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

template <class Record, class Id>
const Record* find_record(const std::vector<Record>& records, Id id) {
    const auto it = std::lower_bound(records.begin(), records.end(), id,
                                     [](const Record& r, Id i) { return r.id < i; });
    return it != records.end() && it->id == id ? &*it : nullptr;
}

/// Returns the parts that an edit has added, by the element that existed before the edit.
std::map<CellId, std::vector<CellId>> parts_by_ancestor(const ChangeSet& changes) {
    std::map<CellId, std::vector<CellId>> parts;
    std::map<CellId, CellId> ancestors;  // of the parts
    for (const CellRecord& record : changes.elements_added) {
        if (record.id.index() < changes.element_capacity_before || !record.parent.is_valid())
            continue;
        // The parent may itself be such a part; it then has a lower id.
        const auto known = ancestors.find(record.parent);
        const CellId ancestor = known == ancestors.end() ? record.parent : known->second;
        ancestors[record.id] = ancestor;
        parts[ancestor].push_back(record.id);
    }
    return parts;
}

/// An element as it was before the edit that divided it. It tells where in the element the nodes of
/// its parts lie. Corners are compared by rest position, since the same edit may have copied or
/// merged their nodes.
class Ancestor {
  public:
    Ancestor(const Mesh& mesh, const ChangeSet& changes, CellId e)
        : mesh_(mesh), changes_(changes) {
        const auto now = mesh.corners(e);
        std::vector<VertexId> corners(now.begin(), now.end());
        auto rewiring = std::lower_bound(
            changes.rewired.begin(), changes.rewired.end(), e,
            [](const topology::CellRewiring& r, CellId id) { return r.element < id; });
        for (; rewiring != changes.rewired.end() && rewiring->element == e; ++rewiring)
            corners[static_cast<std::size_t>(rewiring->corner)] = rewiring->from;
        if (const auto* removed = find_record(changes.elements_removed, e))
            corners = removed->corners;
        for (const VertexId n : corners) rest_positions_.push_back(mesh.rest_position(n));
    }

    /// True if a face of a part lies in the face of the ancestor with the same number. It cannot
    /// lie in another face, since parts keep the local numbers of corners.
    bool has_in_face(FaceId part) {
        unsigned face = 0, corners = 0;
        for (const int k : traits(mesh_.kind(part.cell)).face(part.face)) {
            face |= 1u << k;
            corners |= surrounding(mesh_.corners(part.cell)[static_cast<std::size_t>(k)]);
        }
        return (corners & ~face) == 0;
    }

  private:
    // Returns the corners of the ancestor between which the node lies, as bits. All bits are set
    // if the node does not come from the corners.
    unsigned surrounding(VertexId n) {
        const auto corner =
            std::find(rest_positions_.begin(), rest_positions_.end(), mesh_.rest_position(n));
        if (corner != rest_positions_.end()) return 1u << (corner - rest_positions_.begin());
        const auto [it, is_new] = known_.try_emplace(n, ~0u);
        const VertexRecord* record = find_record(changes_.nodes_added, n);
        if (!is_new || !record) return it->second;
        unsigned corners = 0;
        for (int s = 0; s < record->num_sources; ++s)
            corners |= surrounding(record->sources[static_cast<std::size_t>(s)].node);
        return it->second = corners;
    }

    const Mesh& mesh_;
    const ChangeSet& changes_;
    std::vector<Vec3> rest_positions_;  // of the corners
    std::map<VertexId, unsigned> known_;
};

}  // namespace

CellSet::CellSet(std::vector<CellId> elements) : members_(std::move(elements)) {
    sort_and_make_unique(members_);
}

void CellSet::apply(const Mesh&, const ChangeSet& changes) {
    while (!members_.empty() && members_.back().index() >= changes.element_capacity_after)
        members_.pop_back();
    for (const CellRecord& record : changes.elements_added)
        // New ids are above all others, so that the list stays sorted. An element that an undo
        // brings back is still in the list if it was a member.
        if (record.id.index() >= changes.element_capacity_before &&
            std::binary_search(members_.begin(), members_.end(), record.parent))
            members_.push_back(record.id);
}

FaceSet::FaceSet(std::vector<FaceId> faces) {
    sort_and_make_unique(faces);
    for (const FaceId f : faces) members_.push_back({f, {}});
}

void FaceSet::apply(const Mesh& mesh, const ChangeSet& changes) {
    if (changes.epoch_after < changes.epoch_before) {
        // The edit is an undo: the parts are removed, and their faces return to the members.
        go_back(mesh, topology::inverse(changes));
        const CellId end(changes.element_capacity_after);
        while (!members_.empty() && members_.back().face.cell >= end) members_.pop_back();
        for (Member& member : members_)
            if (member.left_to >= end) member.left_to = {};
        return;
    }
    std::vector<FaceId> born;
    follow_shapes(mesh, changes, born);
    for (const auto& [e, parts] : parts_by_ancestor(changes)) {
        auto member =
            std::lower_bound(members_.begin(), members_.end(), e,
                             [](const Member& m, CellId element) { return m.face.cell < element; });
        if (member == members_.end() || member->face.cell != e) continue;
        if (mesh.is_polyhedron(e)) continue;
        Ancestor ancestor(mesh, changes, e);
        for (; member != members_.end() && member->face.cell == e; ++member) {
            if (member->left_to.is_valid()) continue;
            for (const CellId part : parts)
                if (const FaceId f{part, member->face.face}; ancestor.has_in_face(f))
                    born.push_back(f);
            if (!ancestor.has_in_face(member->face)) member->left_to = parts.front();
        }
    }
    for (const FaceId f : born) members_.push_back({f, {}});
    std::ranges::sort(members_, {}, &Member::face);
}

namespace {

/// Returns the node that a node is after an edit: another one if it was merged into that.
VertexId survivor_of(VertexId n, const ChangeSet& changes) {
    const VertexRecord* record = find_record(changes.nodes_removed, n);
    return record && record->num_sources == 1 ? record->sources[0].node : n;
}

/// True if all corners of a face are corners of another one, or lie between such.
bool lies_in(std::span<const VertexId> part, std::span<const VertexId> whole,
             const ChangeSet& changes) {
    const auto is_in = [&](const auto& self, VertexId n) -> bool {
        if (std::ranges::any_of(whole,
                                [&](VertexId v) { return v == n || survivor_of(v, changes) == n; }))
            return true;
        if (n.index() < changes.node_capacity_before) return false;
        const VertexRecord* record = find_record(changes.nodes_added, n);
        if (!record || record->num_sources == 0) return false;
        for (int s = 0; s < record->num_sources; ++s)
            if (!self(self, record->sources[static_cast<std::size_t>(s)].node)) return false;
        return true;
    };
    return std::ranges::all_of(part, [&](VertexId n) { return is_in(is_in, n); });
}

/// The faces of a cell of which an edit changed the shape, and those into which it divided them: in
/// the cell, and in the parts that it lost. A part of a face has all of its corners in it, and was
/// inside the body if the face was.
class DividedFaces {
  public:
    /// @param parts  that the cell has lost, in ascending order
    DividedFaces(const Mesh& mesh, const ChangeSet& changes, const topology::ShapeChange& change,
                 std::span<const CellId> parts)
        : changes_(changes),
          before_(change.kind_from == topology::CellKind::polyhedron
                      ? change.from
                      : mesh.shape_of_row(change.cell, change.kind_from)) {
        add(change.cell, change.to);
        for (const CellId part : parts) {
            const auto it = std::ranges::lower_bound(changes.shape_changes, part, {},
                                                     &topology::ShapeChange::cell);
            if (it != changes.shape_changes.end() && it->cell == part) add(part, it->to);
        }
    }

    int num_faces() const { return before_.num_faces(); }
    /// Returns the parts of a face, in ascending order.
    std::vector<FaceId> parts_of(int face) const {
        std::vector<FaceId> parts;
        for (const auto& [cell, shape] : after_)
            for (int f = 0; f < shape->num_faces(); ++f)
                if (before_.is_inside(face) == shape->is_inside(f) &&
                    lies_in(shape->face(f), before_.face(face), changes_))
                    parts.push_back({cell, f});
        return parts;
    }

  private:
    void add(CellId cell, const topology::CellShape& shape) { after_.emplace_back(cell, &shape); }

    const ChangeSet& changes_;
    topology::CellShape before_;
    std::vector<std::pair<CellId, const topology::CellShape*>> after_;
};

std::span<const CellId> parts_of(const std::map<CellId, std::vector<CellId>>& parts, CellId e) {
    const auto it = parts.find(e);
    return it == parts.end() ? std::span<const CellId>() : it->second;
}

}  // namespace

/// Removes the members of a cell, but for those that were left to others: they are no faces.
/// Returns the numbers of their faces.
std::vector<int> FaceSet::take_faces(CellId e) {
    const auto of_cell =
        std::ranges::equal_range(members_, e, {}, [](const Member& m) { return m.face.cell; });
    const auto taken = std::ranges::stable_partition(
        of_cell, [](const Member& member) { return member.left_to.is_valid(); });
    std::vector<int> faces;
    for (const Member& member : taken) faces.push_back(member.face.face);
    members_.erase(taken.begin(), taken.end());
    return faces;
}

// The members of a cell that changed its faces are found anew, in it and in the parts that it lost.
void FaceSet::follow_shapes(const Mesh& mesh, const ChangeSet& changes, std::vector<FaceId>& born) {
    if (changes.shape_changes.empty()) return;
    const auto parts = parts_by_ancestor(changes);
    for (const topology::ShapeChange& change : changes.shape_changes) {
        if (change.cell.index() >= changes.element_capacity_before) break;
        const std::vector<int> faces = take_faces(change.cell);
        if (faces.empty()) continue;
        const DividedFaces divided(mesh, changes, change, parts_of(parts, change.cell));
        std::vector<FaceId> of_cell;
        for (const int face : faces)
            std::ranges::copy(divided.parts_of(face), std::back_inserter(of_cell));
        sort_and_make_unique(of_cell);
        born.insert(born.end(), of_cell.begin(), of_cell.end());
    }
}
// A face was a member if all of its parts are. One part does not tell: without area it would lie in
// several faces.
void FaceSet::go_back(const Mesh& mesh, const ChangeSet& changes) {
    if (changes.shape_changes.empty() || members_.empty()) return;
    const auto is_member = [&](FaceId f) {
        const auto [begin, end] = std::ranges::equal_range(members_, f, {}, &Member::face);
        return std::any_of(begin, end, [](const Member& m) { return !m.left_to.is_valid(); });
    };
    const auto has_members = [&](CellId e) {
        return std::ranges::binary_search(members_, e, {},
                                          [](const Member& m) { return m.face.cell; });
    };
    const auto parts = parts_by_ancestor(changes);
    std::vector<FaceId> restored;
    for (const topology::ShapeChange& change : changes.shape_changes) {
        const CellId e = change.cell;
        if (e.index() >= changes.element_capacity_before) break;
        const auto lost = parts_of(parts, e);
        if (!has_members(e) && std::ranges::none_of(lost, has_members)) continue;
        const DividedFaces divided(mesh, changes, change, lost);
        for (int face = 0; face < divided.num_faces(); ++face)
            if (const auto all = divided.parts_of(face);
                !all.empty() && std::ranges::all_of(all, is_member))
                restored.push_back({e, face});
        take_faces(e);
    }
    for (const FaceId f : restored) members_.push_back({f, {}});
    std::ranges::sort(members_, {}, &Member::face);
}

// Members may have ids above those of the mesh; their users skip them.
void CellSet::require_fit() const {
    if (!std::ranges::all_of(members_, &CellId::is_valid) || !std::ranges::is_sorted(members_))
        throw InputError("a selection has elements that cannot be");
}

void FaceSet::require_fit(const Mesh& mesh) const {
    for (const Member& m : members_) {
        const CellId e = m.face.cell;
        const bool can_be =
            e.is_valid() && m.face.face >= 0 &&
            (e.index() >= mesh.element_capacity() || m.face.face < mesh.num_faces(e));
        if (!can_be) throw InputError("a selection has faces that cannot be");
    }
}

}  // namespace incise::physics
