// Smoothing of tetrahedra for the sake of the time step: nodes move so that the flattest elements
// get higher.
// Source: Freitag, Ollivier-Gooch 1997, Tetrahedral mesh improvement using swapping and smoothing.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/mesh_data.h"
#include "tetmesh/body_shape.h"
#include "tetmesh/size_field.h"

namespace incise::tetmesh {

/// Moves nodes of tetrahedra whose least altitude is below `altitude_aim` of the local edge length,
/// one after the other, each to where the least altitude round it is larger. Nodes on the surface
/// of the body, and between two regions, stay on it. Dihedral angles that are below `angle_aim` do
/// not become smaller, and others do not fall below it. The faces on a surface come no further from
/// it than `distance`, but for those that are.
///
/// Perturbation and exudation by Mesh_3 raise dihedral angles, and leave elements that are flat for
/// being small, such as between nodes of the surface that are near to each other.
///
/// @param is_fixed  by node, true on a line or a corner that is to stay
/// @pre all cells are tetrahedra of positive volume that fill the body
/// Cost: for 20,000 tetrahedra, some hundredths of a second.
void raise_altitudes(topology::MeshData& mesh, const std::vector<bool>& is_fixed,
                     const BodyShape& body, const SizeField& sizes, double angle_aim,
                     double distance);

}  // namespace incise::tetmesh
