// How much of each tetrahedron of a cell the material of a fragment fills.
// Source: docs/theory.md, Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// Returns by tetrahedron of CentreDivision how much of it some cells of the material fill, from 0
/// to 1. Empty if they fill all of the carrier, or have next to
/// no volume in it. Faces of the cells are divided into triangles from their corner with the lowest
/// id.
/// @param kind     of the carrier: hexahedron, wedge or pyramid
/// @param corners  of the carrier at rest, in the order of cell_kind.h, m
/// @param cells    inside the carrier, in ascending order
std::vector<double> filled_fractions(topology::CellKind kind, std::span<const Vec3> corners,
                                     const topology::Mesh& material, std::span<const CellId> cells);

/// Scales the result of filled_fractions() so that the volume of all shares is `volume`, m3.
void scale_to_volume(std::vector<double>& fractions, topology::CellKind kind,
                     std::span<const Vec3> corners, double volume);

}  // namespace incise::fragments
