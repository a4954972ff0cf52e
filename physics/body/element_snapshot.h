// The elements of a model at one moment, whose results another thread can work out.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/elements/element_block.h"

namespace incise::physics {

/// Stays as it is while the model moves on and is edited. It is made and destroyed on the thread
/// that does this: see ElementStore::share_blocks. Cost: copies of positions and history.
class ElementSnapshot {
  public:
    explicit ElementSnapshot(const Model& model);

    /// Of all elements.
    /// @param elements all of them, in ascending order
    std::vector<ElementResult> results(std::span<const ElementId> elements) const;

  private:
    std::vector<std::shared_ptr<const ElementBlock>> blocks_;
    std::vector<Vec3> positions_;
    ViscousHistory history_;
};

}  // namespace incise::physics
