// What parts of divided elements take over from the elements that they were parts of.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/topology/change_set.h"

namespace incise::physics {

/// Calls inherit(parent, part) for each part that the edit divided off, a parent that is such a
/// part itself before its own parts. Elements that come back have what they had: they are left out.
template <class Inherit>
void for_each_part(const topology::ChangeSet& changes, Inherit inherit) {
    for (const topology::ElementRecord& record : changes.elements_added)  // in ascending order
        if (record.id.index() >= changes.element_capacity_before && record.parent.is_valid())
            inherit(record.parent, record.id);
}

}  // namespace incise::physics
