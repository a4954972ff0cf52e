// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/cell_set.h"

#include <algorithm>
#include <map>

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
    if (changes.element_capacity_after < changes.element_capacity_before) {
        // The edit is an undo: the parts are removed, and their faces return to the members.
        const CellId end(changes.element_capacity_after);
        while (!members_.empty() && members_.back().face.cell >= end) members_.pop_back();
        for (Member& member : members_)
            if (member.left_to >= end) member.left_to = {};
        return;
    }
    std::vector<FaceId> born;
    for (const auto& [e, parts] : parts_by_ancestor(changes)) {
        auto member =
            std::lower_bound(members_.begin(), members_.end(), e,
                             [](const Member& m, CellId element) { return m.face.cell < element; });
        if (member == members_.end() || member->face.cell != e) continue;
        Ancestor ancestor(mesh, changes, e);
        for (; member != members_.end() && member->face.cell == e; ++member) {
            if (member->left_to.is_valid()) continue;
            for (const CellId part : parts)
                if (const FaceId f{part, member->face.face}; ancestor.has_in_face(f))
                    born.push_back(f);
            if (!ancestor.has_in_face(member->face)) member->left_to = parts.front();
        }
    }
    // New ids are above all others, so that the list stays sorted.
    std::sort(born.begin(), born.end());
    for (const FaceId f : born) members_.push_back({f, {}});
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
