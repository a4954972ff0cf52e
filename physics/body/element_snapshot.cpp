// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/element_snapshot.h"

#include <algorithm>

namespace incise::physics {

ElementSnapshot::ElementSnapshot(const Model& model)
    : blocks_(model.structure().elements().share_blocks()),
      positions_(model.positions().begin(), model.positions().end()),
      history_(model.state().history()) {}

std::vector<ElementResult> ElementSnapshot::results(std::span<const ElementId> elements) const {
    std::vector<ElementResult> by_id, of_block;
    for (const auto& block : blocks_) {
        const auto ids = block->elements();
        if (ids.empty()) continue;
        of_block.resize(ids.size());
        block->results(positions_, history_, of_block);
        by_id.resize(std::max(by_id.size(), ids.back().index() + 1));
        for (std::size_t s = 0; s < of_block.size(); ++s) by_id[ids[s].index()] = of_block[s];
    }
    std::vector<ElementResult> results;
    results.reserve(elements.size());
    for (const ElementId e : elements) results.push_back(by_id[e.index()]);
    return results;
}

}  // namespace incise::physics
