// Meshes of organs by CGAL's Mesh_3 (Delaunay refinement; sliver removal by perturbation and
// exudation). Its implementation includes headers under the GPL.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "data/organs/organ_shapes.h"
#include "incise/topology/mesh_data.h"

namespace incise::organs {

/// Tetrahedra that fill the organ, with faces along the boundary between its regions 1 and 2.
/// The same organ gives the same mesh with one version of CGAL.
/// Throws InputError if the shape is empty or leaves its bounding ball.
/// Cost: 20 000 tetrahedra take some 5 s.
topology::MeshData tetrahedralise(const Organ& organ);

}  // namespace incise::organs
