// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/cut_front.h"

#include <algorithm>

namespace incise::cutting {

using topology::NodeId;

void CutFront::put_on(NodeId n, bool is_exact, double reach, std::uint64_t rank) {
    const auto [place, is_new] = nodes_.try_emplace(n.value, Node{is_exact, reach, rank});
    place->second.reach = std::max(place->second.reach, reach);
    num_new_ += is_new;
    has_changed_ = true;
}

bool CutFront::is_crossed(NodeId a, NodeId b) const {
    const auto place = crossed_.find(a.value);
    return place != crossed_.end() &&
           std::find(place->second.begin(), place->second.end(), b) != place->second.end();
}

void CutFront::toggle(NodeId a, NodeId b) {
    has_changed_ = true;
    const auto toggle_from = [&](NodeId from, NodeId to) {
        auto& others = crossed_[from.value];
        const auto place = std::find(others.begin(), others.end(), to);
        if (place == others.end()) {
            others.push_back(to);
            return;
        }
        others.erase(place);
        if (others.empty()) crossed_.erase(from.value);
    };
    toggle_from(a, b);
    toggle_from(b, a);
}

bool CutFront::is_on(const topology::Mesh& mesh) const {
    return std::all_of(nodes_.begin(), nodes_.end(), [&](const auto& node) {
        const NodeId n(static_cast<std::size_t>(node.first));
        return n.is_valid() && n.index() < mesh.node_capacity();
    });
}

// Of an edge of which both ends were copied, too many copies are noted; the mesh has no such
// edges and nobody will ask for them.
void CutFront::follow(const topology::ChangeSet& changes) {
    if (is_empty() || changes.is_empty()) return;
    has_changed_ = true;
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (record.num_sources != 1) continue;
        const NodeId source = record.sources[0].node;
        if (const auto place = nodes_.find(source.value); place != nodes_.end())
            num_new_ += nodes_.emplace(record.id.value, Node(place->second)).second;
        const auto place = crossed_.find(source.value);
        if (place == crossed_.end()) continue;
        for (const NodeId other : std::vector<NodeId>(place->second)) toggle(record.id, other);
    }
}

void CutFront::forget(const std::vector<NodeId>& nodes) {
    for (const NodeId n : nodes) {
        nodes_.erase(n.value);
        const auto place = crossed_.find(n.value);
        if (place == crossed_.end()) continue;
        for (const NodeId other : std::vector<NodeId>(place->second)) {
            // An edge between a node on the cut and another is forgotten with the former.
            if (!is_on(other)) toggle(n, other);
        }
    }
}

}  // namespace incise::cutting
