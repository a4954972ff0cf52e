// Which faces of the boundary are on a cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"
#include "incise/topology/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// True if a face is on the boundary, and was not before any cut: it was joined to another face in
/// the source, or a cut has divided its carrier there. Of a divided tetrahedron this is decided by
/// rest positions: a face that is nearer than a fiftieth of the carrier's longest edge to one of
/// the carrier's faces counts as a part of that, since cuts move nodes a little.
/// Cost: O(1).
/// @param fragments  of the mesh, at its epoch
bool is_on_cut(const Mesh& mesh, const FragmentMesh& fragments, FaceId face);

}  // namespace incise::topology
