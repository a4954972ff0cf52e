// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/change_set.h"

#include <utility>

namespace incise::topology {

bool ChangeSet::is_empty() const {
    return epoch_before == epoch_after && nodes_added.empty() && nodes_removed.empty() &&
           elements_added.empty() && elements_removed.empty() && rewired.empty() &&
           inside_changes.empty() && faces_opened.empty() && faces_closed.empty();
}

ChangeSet inverse(const ChangeSet& changes) {
    ChangeSet back = changes;
    std::swap(back.epoch_before, back.epoch_after);
    std::swap(back.node_capacity_before, back.node_capacity_after);
    std::swap(back.element_capacity_before, back.element_capacity_after);
    std::swap(back.nodes_added, back.nodes_removed);
    std::swap(back.elements_added, back.elements_removed);
    std::swap(back.faces_opened, back.faces_closed);
    for (Rewiring& rewiring : back.rewired) std::swap(rewiring.from, rewiring.to);
    for (InsideChange& change : back.inside_changes) std::swap(change.from, change.to);
    return back;
}

}  // namespace incise::topology
