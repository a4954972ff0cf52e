// Vectors at the nodes of a block of elements, by the local numbers of these nodes.
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

/// A vector at one node of a block. A fourth number, which is zero, makes it 32 bytes long, so that
/// one instruction can load it.
struct alignas(32) LocalVector {
    double numbers[4] = {};

    LocalVector() = default;
    LocalVector(const Eigen::Vector3d& v) : numbers{v[0], v[1], v[2], 0.0} {}

    auto vector() { return Eigen::Map<Eigen::Vector3d>(numbers); }
    auto vector() const { return Eigen::Map<const Eigen::Vector3d>(numbers); }
    double* data() { return numbers; }
    const double* data() const { return numbers; }
};

/// Returns the index of the first number of a node in an array of LocalVector, seen as doubles.
/// Addressing modes of processors scale an index by 8 bytes, but not by the 32 bytes of a vector.
inline std::uint16_t offset_of(std::uint16_t node) {
    assert(node < 0x4000);  // blocks have fewer nodes
    return static_cast<std::uint16_t>(4 * node);
}

/// Distributes the elements of a block over the lanes of groups and sets the offsets of their
/// corners. The elements fill the first lane of each group in turn, then the second lanes. Elements
/// with neighbouring numbers are therefore in different groups where possible, and the lanes of a
/// group seldom add to the same node.
/// @param groups   receive the offsets; enough for all elements
/// @param corners  local numbers of the nodes of all elements, element by element
/// @param spare    local number of the spare node for lanes without an element
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
