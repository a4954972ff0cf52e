// The carriers of a body that was cut, as files contain them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_data.h"

namespace incise::fragments {

/// Returns the carriers of the living elements, in the order of to_mesh_data(). An element is whole
/// if it has the corners of its carrier. Empty if all are whole. Cost: O(n).
/// @param fragments  of the mesh, at its epoch
topology::Carriers carriers_of(const topology::Mesh& mesh, const FragmentMesh& fragments);

}  // namespace incise::fragments
