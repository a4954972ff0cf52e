// Regular meshes of boxes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// A box of size[0] x size[1] x size[2] metres with its lowest corner at `origin`, divided in
/// cells[0] x cells[1] x cells[2] bricks. Hexahedra are the bricks; tetrahedra are the six of
/// each brick that share its diagonal from the lowest to the highest corner (Kuhn's division),
/// so that neighbouring bricks fit. Points run along x first, then y, then z.
/// @pre sizes are positive and finite, cells at least 1.
MeshData box_mesh(CellKind kind, const Vec3& origin, const Vec3& size, std::array<int, 3> cells);

}  // namespace incise::topology
