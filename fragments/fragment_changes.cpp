// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/fragment_changes.h"

#include <utility>

namespace incise::fragments {

FragmentChanges inverse(FragmentChanges changes) {
    topology::invert(changes.mesh);
    for (ShareChange& share : changes.shares) std::swap(share.from, share.to);
    for (CarriedCell& cell : changes.cells) {
        std::swap(cell.from, cell.to);
        std::swap(cell.is_released, cell.is_joined);
        std::swap(cell.was_around, cell.is_around);
    }
    return changes;
}

}  // namespace incise::fragments
