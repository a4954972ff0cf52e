// Figures that describe a mesh: its size, extent and the shape of its cells.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Lengths in the unit of the points, angles in radians.
struct MeshMetrics {
    std::array<std::size_t, num_cell_kinds> num_of_kind{};  ///< indexed by CellKind
    std::map<int, std::size_t> cells_of_region;
    /// Sum of signed_volume() over the cells.
    double volume = 0.0;
    /// Of the faces that belong to one cell only; a quadrilateral counts the mean of its two
    /// divisions in triangles, which is exact where it is flat.
    double surface_area = 0.0;
    /// Of the points that cells use.
    Vec3 box_min = Vec3::Zero(), box_max = Vec3::Zero();
    /// Each edge counts once, however many cells share it.
    double min_edge_length = 0.0, mean_edge_length = 0.0, max_edge_length = 0.0;
    /// Least distance of a corner from a plane in which a neighbouring corner's face lies: of a
    /// tetrahedron the least altitude, of a brick the least thickness. The tips of pyramids, where
    /// four edges meet, are not looked at from.
    double min_altitude = 0.0;
    /// Least angle between two faces of a cell along their common edge, measured at its ends.
    double min_dihedral_angle = 0.0;
};

/// MeshMetrics::min_altitude of one cell.
double min_altitude(CellKind kind, std::span<const Vec3> corners);

/// Throws InputError with all that check() finds wrong. Cost: O(n log n).
MeshMetrics measure(const MeshData& data);

}  // namespace incise::topology
