// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/change_set.h"

#include <utility>

namespace incise::topology {

bool ChangeSet::is_empty() const {
    return MeshChanges::is_empty() && inside_changes.empty() && faces_opened.empty() &&
           faces_closed.empty();
}

namespace {

template <class Node, class Element>
void invert(MeshChanges<Node, Element>& changes) {
    std::swap(changes.epoch_before, changes.epoch_after);
    std::swap(changes.node_capacity_before, changes.node_capacity_after);
    std::swap(changes.element_capacity_before, changes.element_capacity_after);
    std::swap(changes.nodes_added, changes.nodes_removed);
    std::swap(changes.elements_added, changes.elements_removed);
    for (auto& rewiring : changes.rewired) std::swap(rewiring.from, rewiring.to);
}

}  // namespace

ChangeSet inverse(const ChangeSet& changes) {
    ChangeSet back = changes;
    invert(back);
    std::swap(back.faces_opened, back.faces_closed);
    for (InsideChange& change : back.inside_changes) std::swap(change.from, change.to);
    return back;
}

FragmentMeshChanges inverse(const FragmentMeshChanges& changes) {
    FragmentMeshChanges back = changes;
    invert(back);
    return back;
}

}  // namespace incise::topology
