// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/body_edit.h"

#include <algorithm>
#include <utility>

namespace incise::physics {

namespace {

/// Leaves out the ids that an edit takes away.
template <class Id>
void truncate(std::vector<Id>& ids, std::size_t capacity) {
    ids.erase(std::ranges::lower_bound(ids, Id(capacity)), ids.end());
}

}  // namespace

BodyEdit inverse(BodyEdit edit) {
    edit.material = topology::inverse(edit.material);
    edit.physics = fragments::inverse(std::move(edit.physics));
    for (BodyEdit::Velocity& velocity : edit.velocities) std::swap(velocity.before, velocity.after);
    truncate(edit.touched_vertices, edit.material.node_capacity_after);
    truncate(edit.touched_nodes, edit.physics.mesh.node_capacity_after);
    return edit;
}

}  // namespace incise::physics
