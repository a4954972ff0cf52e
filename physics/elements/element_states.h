// Between lanes and elements: what the fast kernels find of eight elements at a time, for the books
// and for frames.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "incise/base/sum.h"
#include "incise/physics/elements/element_result.h"

namespace incise::physics {

/// Elements of a group, for these purposes always in doubles. Those of a block lie in groups as
/// set_offsets_of_lanes has them; lanes that are left over have anything.
inline constexpr std::size_t elements_together = 8;

/// What the elements of a group have at given positions.
struct ElementEnergies {
    double energy[elements_together];        ///< J
    double volume_ratio[elements_together];  ///< present over rest volume
};
struct ElementStates : ElementEnergies {
    /// Sum of the corners' forces times positions, f x^T, by rows: J.
    double virial[9][elements_together];
};

/// What all elements of a block come to.
struct BlockState {
    Sum elastic_energy;                                                 ///< J
    double min_volume_ratio = std::numeric_limits<double>::infinity();  ///< if it has any

    BlockState& operator+=(const BlockState& o) {
        elastic_energy += o.elastic_energy;
        min_volume_ratio = std::min(min_volume_ratio, o.min_volume_ratio);
        return *this;
    }
};

/// Room for so many groups, until the thread asks again: it takes memory once for all blocks.
template <class Group>
std::span<Group> room_for(std::size_t num_groups) {
    thread_local std::vector<Group> groups;
    groups.resize(num_groups);
    return groups;
}

/// In the order of elements, but for rounding of the sum. What lanes have that are left over is
/// lost.
BlockState state_of_block(std::span<ElementEnergies> groups, std::size_t num_elements);
/// Sets what the elements have, in their order, but volumes at rest, which are read.
void set_results(std::span<const ElementStates> groups, std::span<ElementResult> results);

}  // namespace incise::physics
