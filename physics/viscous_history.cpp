// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/viscous_history.h"

#include <algorithm>

namespace incise::physics {

void ViscousHistory::apply(const topology::ChangeSet& changes) {
    if (is_empty()) return;
    resize(std::max(changes.element_capacity_before, changes.element_capacity_after));
    // In ascending order: the parent may be a part that the edit made before.
    for (const topology::ElementRecord& record : changes.elements_added) {
        if (record.id.index() < changes.element_capacity_before) continue;  // back with what it had
        if (!record.parent.is_valid()) continue;
        const auto inherited = of(record.parent);
        std::copy(inherited.begin(), inherited.end(), of(record.id).begin());
    }
    resize(changes.element_capacity_after);
}

}  // namespace incise::physics
