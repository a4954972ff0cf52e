// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/element_block.h"

#include <utility>

namespace incise::physics {

std::span<const LocalVector> ElementBlock::local_positions(
    std::span<const Vec3> positions, std::vector<LocalVector>& offsets) const {
    offsets.reserve(max_elements * topology::max_corners + 1);  // enough for any block
    offsets.resize(nodes_.size() + 1);
    for (std::size_t i = 0; i < nodes_.size(); ++i) offsets[i] = positions[nodes_[i]];
    offsets.back() = {};
    return offsets;
}

std::span<const LocalVector> ElementBlock::local_positions(std::span<const Vec3> positions) const {
    thread_local std::vector<LocalVector> offsets;
    return local_positions(positions, offsets);
}

void ElementBlock::note_change(ElementId e, std::span<const NodeId> corners) {
    Changed& changed = changed_.emplace_back();
    changed.element = e;
    for (std::size_t k = 0; k < corners.size(); ++k)
        changed.nodes[k] = static_cast<std::uint32_t>(corners[k].index());
    is_numbered_ = false;
}

std::size_t ElementBlock::add_slot(ElementId e, std::span<const NodeId> corners) {
    const auto it = std::lower_bound(elements_.begin(), elements_.end(), e);
    const auto s = static_cast<std::size_t>(it - elements_.begin());
    elements_.insert(it, e);
    local_corners_.insert(local_corners_.begin() + static_cast<std::ptrdiff_t>(s * num_corners_),
                          num_corners_, unnumbered);
    note_change(e, corners);
    have_moved_ = true;
    return s;
}

void ElementBlock::change_slot(std::size_t s, std::span<const NodeId> corners) {
    if (is_changed(s)) forget_change(elements_[s]);
    std::ranges::fill(local_corners(s), unnumbered);
    note_change(elements_[s], corners);
}

void ElementBlock::remove_slot(std::size_t s) {
    if (is_changed(s)) forget_change(elements_[s]);
    elements_.erase(elements_.begin() + static_cast<std::ptrdiff_t>(s));
    const auto first = local_corners_.begin() + static_cast<std::ptrdiff_t>(s * num_corners_);
    local_corners_.erase(first, first + static_cast<std::ptrdiff_t>(num_corners_));
    is_numbered_ = false;
    have_moved_ = true;
}

void ElementBlock::number_nodes(std::span<std::uint16_t> local_numbers,
                                std::span<const Vec3> rest_positions) {
    if (is_numbered_) return;
    const std::size_t num_had = nodes_.size();
    for (std::size_t i = 0; i < num_had; ++i)
        local_numbers[nodes_[i]] = static_cast<std::uint16_t>(i);
    // New nodes are appended for now and sorted in below.
    std::vector<std::size_t> changed;
    for (const auto& [element, nodes] : std::exchange(changed_, {})) {
        changed.push_back(slot_of(element));
        const std::span<std::uint16_t> numbers = local_corners(changed.back());
        for (std::size_t k = 0; k < num_corners_; ++k) {
            const std::uint32_t n = nodes[k];
            if (local_numbers[n] == unnumbered) {
                local_numbers[n] = static_cast<std::uint16_t>(nodes_.size());
                nodes_.push_back(n);
            }
            numbers[k] = local_numbers[n];
        }
    }

    std::vector<std::uint16_t> new_numbers(nodes_.size(), unnumbered);
    for (const std::uint16_t number : local_corners_) new_numbers[number] = 0;  // still in use
    const auto first_new = nodes_.begin() + static_cast<std::ptrdiff_t>(num_had);
    std::sort(first_new, nodes_.end());
    std::inplace_merge(nodes_.begin(), first_new, nodes_.end());
    std::erase_if(nodes_, [&](std::uint32_t n) {
        if (new_numbers[local_numbers[n]] != unnumbered) return false;
        local_numbers[n] = unnumbered;
        return true;
    });
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        std::uint16_t& number = local_numbers[nodes_[i]];
        new_numbers[number] = static_cast<std::uint16_t>(i);
        number = unnumbered;
    }
    for (std::uint16_t& number : local_corners_) number = new_numbers[number];

    use_numbers(changed, rest_positions);
    is_numbered_ = true;
    have_moved_ = false;
}

}  // namespace incise::physics
