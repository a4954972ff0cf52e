// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/change_set.h"

#include <utility>

namespace incise::topology {

bool ChangeSet::is_empty() const {
    return MeshChanges::is_empty() && inside_changes.empty() && faces_opened.empty() &&
           faces_closed.empty();
}

ChangeSet inverse(const ChangeSet& changes) {
    ChangeSet back = changes;
    invert(back);
    std::swap(back.faces_opened, back.faces_closed);
    for (InsideChange& change : back.inside_changes) std::swap(change.from, change.to);
    return back;
}

}  // namespace incise::topology
