// Results of the SIMD kernels for groups of eight elements, and their conversion to totals of a
// block and to results of single elements.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "incise/base/sum.h"
#include "incise/physics/elements/element_result.h"

namespace incise::physics {

/// The number of elements in a group. These results are always in doubles. For the order of the
/// elements of a block in groups see set_offsets_of_lanes(). Lanes without an element have
/// arbitrary values.
inline constexpr std::size_t elements_together = 8;
/// The largest number of elements in a block.
inline constexpr std::size_t most_elements_of_block = 512;

/// Energies and volume ratios of the elements of a group.
struct ElementEnergies {
    double energy[elements_together];        ///< J
    double volume_ratio[elements_together];  ///< current over rest volume
};
/// Energies, volume ratios and virials of the elements of a group.
struct ElementStates : ElementEnergies {
    /// Sum over the corners of force times position, f x^T, by rows, J.
    double virial[9][elements_together];
};

/// Totals of the elements of a block.
struct BlockState {
    Sum elastic_energy;                                                 ///< J
    double min_volume_ratio = std::numeric_limits<double>::infinity();  ///< infinite if empty

    BlockState& operator+=(const BlockState& o) {
        elastic_energy += o.elastic_energy;
        min_volume_ratio = std::min(min_volume_ratio, o.min_volume_ratio);
        return *this;
    }
};

/// Returns a buffer of `num_groups` groups, or of as many numbers, that belongs to the calling
/// thread. All blocks use the same buffer. It has room for any block from the start, so that memory
/// is allocated only once, also if the first block is a small one.
/// @lifetime Until the next call on this thread with the same type of group.
template <class Group>
std::span<Group> room_for(std::size_t num_groups) {
    constexpr std::size_t in_group = std::is_arithmetic_v<Group> ? 1 : elements_together;
    thread_local std::vector<Group> groups;
    groups.reserve(most_elements_of_block / in_group);
    groups.resize(num_groups);
    return groups;
}

/// Returns the totals of a block. Energies are summed lane by lane, so that the sum differs within
/// rounding from one in the order of the elements. Lanes without an element are overwritten.
BlockState state_of_block(std::span<ElementEnergies> groups, std::size_t num_elements);
/// Sets energy, volume ratio and stress of each element, in the order of the block.
/// @pre  the rest volumes in `results` are set
void set_results(std::span<const ElementStates> groups, std::span<ElementResult> results);

}  // namespace incise::physics
