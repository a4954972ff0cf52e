// A mesh as plain arrays: what readers deliver, generators make and writers take.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

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
    /// For messages: what the source calls its cells and points, one each. Empty where that is
    /// their number here.
    std::vector<std::int64_t> source_cells, source_points;
    /// Of each point the one that stands for it since weld(): itself, or a lower one. Empty where
    /// no point was welded to another.
    std::vector<std::int64_t> welded_to;
    /// Points at one position are meant to be apart, as those on the two faces of a cut are.
    bool points_may_coincide = false;

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

    bool is_welded(std::size_t p) const {
        return !welded_to.empty() && welded_to[p] != static_cast<std::int64_t>(p);
    }

    /// "cell 3 (tetrahedron)", with what the source calls it.
    std::string cell_name(std::size_t c) const {
        std::string name = "cell " + std::to_string(c) + " (" + traits(kinds[c]).name;
        if (c < source_cells.size())
            name += ", number " + std::to_string(source_cells[c]) + " in the file";
        return name + ")";
    }

    /// "point 3", with what the source calls it.
    std::string point_name(std::size_t p) const {
        const std::string name = "point " + std::to_string(p);
        if (p >= source_points.size()) return name;
        return name + " (number " + std::to_string(source_points[p]) + " in the file)";
    }
};

}  // namespace incise::topology
