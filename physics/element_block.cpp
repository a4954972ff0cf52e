// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/element_block.h"

namespace incise::physics {

std::span<const LocalVector> ElementBlock::local_positions(std::span<const Vec3> positions,
                                                           std::vector<LocalVector>& places) const {
    places.reserve(max_elements * topology::max_corners + 1);  // of any block
    places.resize(nodes_.size() + 1);
    for (std::size_t i = 0; i < nodes_.size(); ++i) places[i] = positions[nodes_[i]];
    places.back() = {};
    return places;
}

std::span<const LocalVector> ElementBlock::local_positions(std::span<const Vec3> positions) const {
    thread_local std::vector<LocalVector> places;
    return local_positions(positions, places);
}

void ElementBlock::number_nodes(std::span<std::uint16_t> local_numbers) {
    if (is_numbered_) return;
    nodes_.clear();
    for (std::size_t s = 0; s < elements_.size(); ++s)
        for (const std::uint32_t n : corners_of(s))
            if (local_numbers[n] == unnumbered) {
                local_numbers[n] = 0;
                nodes_.push_back(n);
            }
    std::sort(nodes_.begin(), nodes_.end());
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        local_numbers[nodes_[i]] = static_cast<std::uint16_t>(i);
    use_numbers(local_numbers);
    for (const std::uint32_t n : nodes_) local_numbers[n] = unnumbered;
    is_numbered_ = true;
}

}  // namespace incise::physics
