// Regular meshes of boxes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Returns the mesh of a box, divided into cells[0] x cells[1] x cells[2] bricks.
/// For hexahedra, each brick is one cell. For tetrahedra, each brick is divided into the six that
/// share its diagonal from the lowest to the highest corner (Kuhn's division), so that the faces of
/// neighbouring bricks match. Points are numbered along x first, then y, then z.
/// @param kind    hexahedron or tetrahedron
/// @param origin  the lowest corner of the box, m
/// @param size    the edge lengths of the box, m
/// @param cells   the number of bricks along x, y and z
/// @pre  sizes are positive and finite, numbers of bricks at least 1
MeshData box_mesh(CellKind kind, const Vec3& origin, const Vec3& size, std::array<int, 3> cells);

}  // namespace incise::topology
