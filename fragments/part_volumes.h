// How much of a polyhedron is in each tetrahedron of a cell.
// Source: docs/theory.md, Hexahedra, wedges and pyramids, Cut cells.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/diagonals.h"

namespace incise::fragments {

/// Numbers by tetrahedron of CentreDivision; in cells that have fewer, the others are zero.
inline constexpr std::size_t max_parts = 24;
using PartNumbers = std::array<double, max_parts>;

/// Returns how many tetrahedra a kind of cell is divided into: see CentreDivision.
/// @pre  the kind is hexahedron, wedge or pyramid
std::size_t num_parts(topology::CellKind kind);
/// Returns the volumes of the tetrahedra of a cell, m3.
/// @param kind     hexahedron, wedge or pyramid
/// @param corners  in the order of cell_kind.h, m
PartNumbers part_volumes(topology::CellKind kind, std::span<const Vec3> corners,
                         topology::Diagonals diagonals = {});

/// Returns the volume of a polyhedron in each tetrahedron of a cell, over that of the tetrahedron.
/// It is exact within rounding, and exactly 0 or 1 where it is so within rounding.
/// @param kind     hexahedron, wedge or pyramid
/// @param corners  of the cell, in the order of cell_kind.h, m
/// @param surface  of the polyhedron: closed, its triangles anticlockwise as seen from outside. The
///                 polyhedron may be of any shape, and reach out of the cell.
/// Cost: about a microsecond for each triangle.
PartNumbers part_fractions(topology::CellKind kind, std::span<const Vec3> corners,
                           std::span<const std::array<Vec3, 3>> surface,
                           topology::Diagonals diagonals = {});

}  // namespace incise::fragments
