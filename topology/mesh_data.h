// A mesh as plain arrays: what readers deliver, generators make and writers take.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "topology/cell_kind.h"
#include "topology/types.h"

namespace incise::topology {

/// Cells over points, numbered from 0 in the order of the source. Nothing is promised about the
/// contents: Mesh::build checks them.
struct MeshData {
    std::vector<Vec3> points;     ///< rest positions
    std::vector<CellKind> kinds;  ///< one a cell
    std::vector<std::size_t> offsets{
        0};  ///< #cells + 1; cell c has corners [offsets[c], offsets[c+1])
    std::vector<std::int64_t> corners;  ///< point numbers, VTK order within a cell
    std::vector<int> regions;           ///< one a cell

    std::size_t num_cells() const { return kinds.size(); }

    std::span<const std::int64_t> cell(std::size_t c) const {
        return std::span(corners).subspan(offsets[c], offsets[c + 1] - offsets[c]);
    }

    void add_cell(CellKind kind, std::span<const std::int64_t> cell_corners, int region = 0) {
        kinds.push_back(kind);
        corners.insert(corners.end(), cell_corners.begin(), cell_corners.end());
        offsets.push_back(corners.size());
        regions.push_back(region);
    }
};

}  // namespace incise::topology
