// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/component_count.h"

#include <algorithm>
#include <cstddef>

#include "incise/base/disjoint_set.h"

namespace incise::topology {

namespace {

/// Returns the elements that an edit touched, in ascending order: removed and added elements, and
/// those at opened and closed faces.
std::vector<CellId> touched_elements(const ChangeSet& changes) {
    std::vector<CellId> touched;
    for (const auto* pairs : {&changes.faces_opened, &changes.faces_closed})
        for (const FacePair& pair : *pairs)
            touched.insert(touched.end(), {pair.a.cell, pair.b.cell});
    for (const auto* records : {&changes.elements_removed, &changes.elements_added})
        for (const CellRecord& record : *records) touched.push_back(record.id);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    return touched;
}

std::vector<FaceId> sides_of(const std::vector<FacePair>& pairs) {
    std::vector<FaceId> sides;
    for (const FacePair& pair : pairs) sides.insert(sides.end(), {pair.a, pair.b});
    std::sort(sides.begin(), sides.end());
    return sides;
}

bool has(const std::vector<CellRecord>& records, CellId e) {
    const auto it =
        std::lower_bound(records.begin(), records.end(), e,
                         [](const CellRecord& record, CellId id) { return record.id < id; });
    return it != records.end() && it->id == e;
}

}  // namespace

// A breadth-first search from all touched elements at once, through the faces that were joined
// before the edit and still are. Groups that meet are joined. The search ends when at most one
// group still has elements in the queue.
DisjointSet ComponentCount::search(const Mesh& mesh, const ChangeSet& changes,
                                   const std::vector<CellId>& touched, std::vector<CellId>& found) {
    const std::vector<FaceId> new_faces = sides_of(changes.faces_closed);
    DisjointSet groups(touched.size());
    std::vector<CellId> queue;
    std::vector<int> num_waiting(touched.size());  // number of elements in the queue, by group
    const auto waiting = [&](std::int32_t g) -> int& {
        return num_waiting[static_cast<std::size_t>(g)];
    };
    for (const CellId e : touched) {
        if (!mesh.is_alive(e) || has(changes.elements_added, e)) continue;
        queue.push_back(e);
        waiting(group_of(e)) = 1;
    }
    auto num_searching = static_cast<std::ptrdiff_t>(queue.size());
    for (std::size_t next = 0; next < queue.size() && num_searching > 1; ++next) {
        const CellId e = queue[next];
        std::int32_t own = groups.find(group_of(e));
        for (int f = 0; f < mesh.num_faces(e); ++f) {
            const CellId other = mesh.neighbor({e, f}).cell;
            if (!other.is_valid() ||
                std::binary_search(new_faces.begin(), new_faces.end(), FaceId{e, f}))
                continue;
            if (group_of(other) < 0) {
                group_of(other) = own;
                ++waiting(own);
                found.push_back(other);
                queue.push_back(other);
            } else if (const std::int32_t others = groups.find(group_of(other)); others != own) {
                num_searching -= waiting(others) > 0;
                const int sum = waiting(own) + waiting(others);
                own = groups.join(own, others);
                waiting(own) = sum;
            }
        }
        num_searching -= --waiting(own) == 0;
    }
    return groups;
}

// Components without a touched element have not changed. The others are counted before and after
// the edit. The groups that the search finds are connected both before and after it. Before the
// edit, the opened faces connect them too; after it, the closed faces do.
void ComponentCount::apply(const Mesh& mesh, const ChangeSet& changes) {
    epoch_.advance(mesh, changes, "count of components");
    const std::vector<CellId> touched = touched_elements(changes);
    group_of_.resize(std::max(group_of_.size(), mesh.element_capacity()), -1);
    for (std::size_t i = 0; i < touched.size(); ++i)
        group_of(touched[i]) = static_cast<std::int32_t>(i);
    std::vector<CellId> found;
    DisjointSet before = search(mesh, changes, touched, found), after = before;
    for (const FacePair& pair : changes.faces_opened)
        before.join(group_of(pair.a.cell), group_of(pair.b.cell));
    for (const FacePair& pair : changes.faces_closed)
        after.join(group_of(pair.a.cell), group_of(pair.b.cell));
    std::vector<bool> had(touched.size()), has_now(touched.size());
    for (const CellId e : touched) {
        if (!has(changes.elements_added, e))
            had[static_cast<std::size_t>(before.find(group_of(e)))] = true;
        if (mesh.is_alive(e)) has_now[static_cast<std::size_t>(after.find(group_of(e)))] = true;
    }
    value_ += static_cast<int>(std::count(has_now.begin(), has_now.end(), true) -
                               std::count(had.begin(), had.end(), true));
    found.insert(found.end(), touched.begin(), touched.end());
    for (const CellId e : found) group_of(e) = -1;
}

}  // namespace incise::topology
