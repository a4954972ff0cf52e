// A copy of the elements of a model at one time, from which another thread can compute results.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "incise/physics/body/model.h"
#include "incise/physics/elements/element_block.h"

namespace incise::physics {

/// The state of all elements at one time. Later steps and edits of the model do not change it.
/// @thread It must be created and destroyed on the thread that edits the model; see
/// ElementStore::share_blocks. Other threads may call results().
class ElementSnapshot {
  public:
    /// Cost: copies of the positions and of the history.
    explicit ElementSnapshot(const Model& model);

    /// Returns the results of the given fragments, which were alive at the time of the snapshot.
    std::vector<ElementResult> results(std::span<const ElementId> elements) const;

  private:
    std::vector<std::shared_ptr<const ElementBlock>> blocks_;
    std::vector<Vec3> positions_;
    ViscousHistory history_;
};

}  // namespace incise::physics
