// The number of closed parts of a surface, and of its handles.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace incise::tetmesh {

/// What stays the same of a closed surface however it is deformed.
struct SurfaceTopology {
    std::int64_t num_parts = 0;
    std::int64_t euler = 0;  ///< characteristic: corners - edges + triangles

    /// A ball has none, a ring one.
    std::int64_t num_handles() const { return num_parts - euler / 2; }
    SurfaceTopology& operator+=(const SurfaceTopology& other) {
        num_parts += other.num_parts;
        euler += other.euler;
        return *this;
    }
    bool operator==(const SurfaceTopology&) const = default;
};

/// Returns the topology of a closed surface. Triangles that meet at a corner alone have a corner
/// each.
/// @pre an even number of triangles meet at each edge
/// Cost: O(n log n).
SurfaceTopology topology_of(std::span<const std::array<std::int64_t, 3>> triangles);

}  // namespace incise::tetmesh
