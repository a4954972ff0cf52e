// Cells of all kinds divided into tetrahedra that hang together as the cells do.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// A point of a source, and its weight in a mean.
struct PointWeight {
    std::int64_t point = 0;
    double weight = 0.0;
};

/// The result of divide_into_tetrahedra().
struct TetrahedralDivision {
    MeshData mesh;  ///< the points of the source, then those that were added
    /// By added point, what it is the mean of. The weights sum to 1.
    std::vector<std::vector<PointWeight>> added;
    std::vector<std::size_t> cells;  ///< by tetrahedron, the cell of the source
    /// The cells of the source of which some tetrahedra are turned inside out, in ascending order.
    std::vector<std::size_t> inverted;
};

/// True if all cells are tetrahedra, so that there is nothing to divide.
bool has_only_tetrahedra(const MeshData& data);

/// Divides all cells that are no tetrahedra. It is the division with which the physics moves them:
/// a cell is divided about the mean of its corners, and a face of four or more corners about the
/// mean of its own. So a tetrahedron stands on each edge of each such face, and one on each
/// triangle. A quadrilateral that is joined to two triangles is divided into these.
///
/// A face that two cells share has one division. So the tetrahedra hang together where the cells
/// do, and only there: they have the same connected components, and each inner face belongs to two.
/// The volume is that of the cells to rounding, also where faces are warped: the triangles about
/// the middle of a face bound the volume of its bilinear patch. The area of a warped face is that
/// of its triangles.
///
/// A face that is not convex is divided between its corners, by Ears: about its middle, triangles
/// would be turned. A cell whose middle does not see all of its surface is filled by
/// fill_surface(), so that all tetrahedra have their right side out. If its surface crosses itself,
/// there is no such filling, and some are turned inside out.
///
/// The tetrahedra have the region of their cell, and its faces on cuts. They have no carriers.
/// A hexahedron gives 24 of them, a wedge 14 and a pyramid 8.
/// Cost: O(n log n), some microseconds a cell.
/// @pre  the lists of `data` are sound: see check()
TetrahedralDivision divide_into_tetrahedra(const MeshData& data);

}  // namespace incise::topology
