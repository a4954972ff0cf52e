// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/viscous_history.h"

#include <algorithm>

#include "incise/topology/field.h"

namespace incise::physics {

void ViscousHistory::apply(const fragments::FragmentMesh&,
                           const fragments::FragmentMeshChanges& changes) {
    if (is_empty()) return;
    resize(std::max(changes.element_capacity_before, changes.element_capacity_after));
    topology::for_each_part(changes, [&](ElementId parent, ElementId part) {
        const auto inherited = of(parent);
        std::copy(inherited.begin(), inherited.end(), of(part).begin());
    });
    resize(changes.element_capacity_after);
}

}  // namespace incise::physics
