// Tetrahedra of a body by CGAL's Mesh_3: Delaunay refinement (Jamin, Alliez, Yvinec, Boissonnat
// 2015), then removal of slivers by perturbation and exudation.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <functional>
#include <string_view>

#include "incise/topology/mesh_data.h"
#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// Lengths of edges to aim at.
struct ElementSizes {
    double inside = 0.0;   ///< far from the surface
    double surface = 0.0;  ///< on the surface and between regions; at most `inside`
};

/// Is told how much is done, from 0 to 1, and what is being done.
using Observer = std::function<void(double fraction, std::string_view note)>;

/// Returns the mesh of a body. Its regions are those of the body, and neighbours share their faces.
/// The same body and sizes give the same mesh.
///
/// Throws InputError, without the name of a file, if no tetrahedron comes out, or if there are many
/// more than the sizes let expect.
/// Cost: for 20,000 tetrahedra one to two seconds; most of that goes to the removal of slivers.
topology::MeshData tetrahedra_of(const BodyShape& body, const ElementSizes& sizes,
                                 const Observer& observer);

}  // namespace incise::tetmesh
