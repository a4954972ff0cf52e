// The nodes of a block of elements, by numbers of its own.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace incise::physics {

/// What a block has of one of its nodes: a vector in space with a fourth number, which is zero, so
/// that all of it is loaded at once.
struct alignas(32) LocalVector {
    double numbers[4] = {};

    LocalVector() = default;
    LocalVector(const Eigen::Vector3d& v) : numbers{v[0], v[1], v[2], 0.0} {}

    auto vector() { return Eigen::Map<Eigen::Vector3d>(numbers); }
    auto vector() const { return Eigen::Map<const Eigen::Vector3d>(numbers); }
    double* data() { return numbers; }
    const double* data() const { return numbers; }
};

/// Where the vector of the node of the given local number begins, in numbers: what processors add
/// to an address as it is, while a number of vectors of 32 bytes has to be multiplied first.
inline std::uint16_t offset_of(std::uint16_t node) {
    assert(node < 0x4000);  // blocks are smaller
    return static_cast<std::uint16_t>(4 * node);
}

/// Sets the offsets of the corners of elements that lie side by side in groups: one after the other
/// in the first lane of each group, then in the second. So neighbours lie in different groups, as
/// far as may be, and the lanes of a group seldom add to the same node.
/// @param corners  local numbers of the nodes of all elements, those of one after the other
/// @param spare    local number of a node that lanes without an element work on
template <class Group>
void set_offsets_of_lanes(std::vector<Group>& groups, std::span<const std::uint16_t> corners,
                          std::uint16_t spare) {
    constexpr std::size_t num_corners = std::extent_v<decltype(Group::offsets)>;
    std::size_t next = 0;
    for (std::size_t lane = 0; lane < Group::size; ++lane)
        for (Group& group : groups)
            for (std::size_t k = 0; k < num_corners; ++k)
                group.offsets[k][lane] = offset_of(next < corners.size() ? corners[next++] : spare);
}

}  // namespace incise::physics
