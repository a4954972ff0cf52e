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
    // Most nodes are those it had, which stand in order; the others are few and are merged in.
    constexpr std::uint16_t had = 0, has = 1;
    const auto num_had = static_cast<std::ptrdiff_t>(nodes_.size());
    for (const std::uint32_t n : nodes_) local_numbers[n] = had;
    for (std::size_t s = 0; s < elements_.size(); ++s)
        for (const std::uint32_t n : corners_of(s)) {
            if (local_numbers[n] == unnumbered) nodes_.push_back(n);
            local_numbers[n] = has;
        }
    std::sort(nodes_.begin() + num_had, nodes_.end());
    std::inplace_merge(nodes_.begin(), nodes_.begin() + num_had, nodes_.end());
    std::erase_if(nodes_, [&](std::uint32_t n) {
        if (local_numbers[n] == has) return false;
        local_numbers[n] = unnumbered;
        return true;
    });
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        local_numbers[nodes_[i]] = static_cast<std::uint16_t>(i);
    use_numbers(local_numbers);
    for (const std::uint32_t n : nodes_) local_numbers[n] = unnumbered;
    is_numbered_ = true;
}

}  // namespace incise::physics
