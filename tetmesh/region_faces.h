// The faces of a mesh at which regions end.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::tetmesh {

/// A triangle between two regions. Its nodes run anticlockwise as seen from the outer one.
struct RegionFace {
    std::array<std::int64_t, 3> nodes;
    int inner = 0;  ///< the region of one of its tetrahedra
    int outer = 0;  ///< 0 on the surface of the body; else more than `inner`

    bool has_regions_of(const RegionFace& other) const {
        return inner == other.inner && outer == other.outer;
    }
};

/// Returns the faces of tetrahedra between regions, and those on the surface of the body. Of two
/// regions the lower one is the inner one. Cost: O(n log n).
std::vector<RegionFace> region_faces(const topology::MeshData& mesh);

}  // namespace incise::tetmesh
