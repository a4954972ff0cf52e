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
/// Each row must have a tetrahedron of positive volume. A cell must be a tetrahedron inside its
/// carrier. Cells of a carrier must have one region, and together no more volume than the carrier.
/// Carriers of cells that share a face must share its corners, with equal positions.
/// @pre  the lists of `data` are sound, except for the carriers
/// @param shared_faces  all faces between the cells
/// Cost: O(n).
std::string fault_of_carriers(const MeshData& data, std::span<const SharedFace> shared_faces);

}  // namespace incise::topology
