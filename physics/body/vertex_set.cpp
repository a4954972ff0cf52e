// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/vertex_set.h"

#include <algorithm>

#include "incise/base/error.h"

namespace incise::physics {

VertexSet::VertexSet(std::vector<VertexId> vertices) {
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const VertexId v : vertices) members_.push_back({v, v});
}

const VertexSet::Member* VertexSet::find(VertexId n) const {
    const auto it = std::lower_bound(members_.begin(), members_.end(), n,
                                     [](const Member& m, VertexId id) { return m.node < id; });
    return it != members_.end() && it->node == n ? &*it : nullptr;
}

void VertexSet::apply(const topology::Mesh&, const topology::ChangeSet& changes) {
    if (members_.empty()) return;
    while (!members_.empty() && members_.back().node.index() >= changes.node_capacity_after)
        members_.pop_back();
    for (const topology::VertexRecord& record : changes.nodes_added) {
        // A node that an undo brings back is still in the list if it was a member. Its sources do
        // not matter.
        if (record.id.index() < changes.node_capacity_before) continue;
        bool all = true;
        for (int s = 0; s < record.num_sources && all; ++s)
            all = contains(record.sources[static_cast<std::size_t>(s)].node);
        if (!all) continue;
        // New ids are above all others, so that the list stays sorted.
        const bool is_copy = record.num_sources == 1;
        members_.push_back(
            {record.id, is_copy ? find(record.sources[0].node)->origin : VertexId()});
    }
}

void VertexSet::require_fit(const topology::Mesh& mesh) const {
    const auto is_there = [&](VertexId n) { return n.index() < mesh.node_capacity(); };
    for (const Member& m : members_)
        if (!m.node.is_valid() || !is_there(m.node))
            throw InputError("a selection has nodes that are not there");
    if (std::ranges::adjacent_find(members_, std::ranges::greater_equal(), &Member::node) !=
        members_.end())
        throw InputError("a selection of nodes is out of order");
}

}  // namespace incise::physics
