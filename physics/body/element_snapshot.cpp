// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/element_snapshot.h"

#include <algorithm>
#include <cassert>

namespace incise::physics {

ElementSnapshot::ElementSnapshot(const Model& model)
    : blocks_(model.elements().share_blocks()),
      positions_(model.positions().begin(), model.positions().end()),
      history_(model.history()) {}

std::vector<ElementResult> ElementSnapshot::results(std::span<const ElementId> elements) const {
    assert(std::is_sorted(elements.begin(), elements.end()));
    std::vector<std::size_t> row_of(elements.empty() ? 0 : elements.back().index() + 1);
    for (std::size_t i = 0; i < elements.size(); ++i) row_of[elements[i].index()] = i;
    std::vector<ElementResult> results(elements.size()), of_block;
    for (const auto& block : blocks_) {
        of_block.resize(block->elements().size());
        block->results(positions_, history_, of_block);
        for (std::size_t s = 0; s < of_block.size(); ++s)
            results[row_of[block->elements()[s].index()]] = of_block[s];
    }
    return results;
}

}  // namespace incise::physics
