// How much of each tetrahedron of a cell the material of a fragment fills.
// Source: docs/theory.md, Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/diagonals.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// Returns by tetrahedron of CentreDivision how much of it some cells of the material fill, from 0
/// to 1. Empty if they fill all of the carrier, or have next to
/// no volume in it. Plane faces of the cells are divided into triangles from their corner with the
/// lowest id, others about the mean of their corners.
/// @param kind     of the carrier: hexahedron, wedge or pyramid
/// @param corners  of the carrier at rest, in the order of cell_kind.h, m
/// @param cells    inside the carrier, in ascending order
/// @param diagonals  that divide faces of the carrier
std::vector<double> filled_fractions(topology::CellKind kind, std::span<const Vec3> corners,
                                     const topology::Mesh& material, std::span<const CellId> cells,
                                     topology::Diagonals diagonals = {});

/// Makes the fractions of parts that fill a carrier together add up to given sums, by tetrahedron.
/// Those of parts that lie beside each other do so within rounding. A cut with bends that are
/// smaller than a cell can leave parts that reach into each other.
/// @param fractions  those of each part, none empty
/// @param sums       not negative
void fit_together(std::vector<std::vector<double>>& fractions, std::span<const double> sums);

}  // namespace incise::fragments
