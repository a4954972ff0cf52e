// Points in hexahedra, wedges and pyramids as combinations of their corners.
// Source: docs/theory.md, Hexahedra, wedges and pyramids, and Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/diagonals.h"

namespace incise::fragments {

/// Returns the weights of the corners of a cell, in their order, for a point that moves with the
/// cell. The motion of the cell is linear in each tetrahedron of CentreDivision. The point is in
/// the tetrahedron with the largest least barycentric coordinate; for a point outside the cell that
/// is one of the nearest. Weights sum to 1.
///
/// On a face of the cell, within rounding, the weights are those of the corners of this face. They
/// depend on the positions of these corners only, and are the same bits in all cells with the face.
/// On an edge they are those of its two ends. A face that a diagonal divides is two faces here, and
/// the diagonal is an edge.
/// @param kind     hexahedron, wedge or pyramid
/// @param corners  at rest, in the order of cell_kind.h, m
/// @param x        at rest, m
/// Cost: some microseconds.
std::array<double, topology::max_corners> weights_in_cell(topology::CellKind kind,
                                                          std::span<const Vec3> corners,
                                                          const Vec3& x,
                                                          topology::Diagonals diagonals = {});

}  // namespace incise::fragments
