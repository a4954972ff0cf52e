// The check of the carriers of a body that was cut, before a mesh is built with them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Returns why the carriers cannot be those of the cells, with a remedy. Empty if they can be.
///
/// Each row must have a cell of positive volume. A part must be a polyhedron, or a tetrahedron of a
/// tetrahedron, and inside its carrier. Cells of a carrier must have one region, and together no
/// more volume than the carrier. A polyhedron must have a positive volume and plane faces, within
/// what cuts leave. Carriers of cells that share a face must share three corners or more, with
/// equal positions.
/// @pre  the lists of `data` are sound, except for the carriers
/// @param shared_faces  all faces between the cells
/// Cost: O(n).
std::string fault_of_carriers(const MeshData& data, std::span<const SharedFace> shared_faces);

}  // namespace incise::topology
