// Quadrilaterals of a source that meet two triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "incise/topology/diagonals.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/source_faces.h"

namespace incise::topology {

/// Returns the quadrilaterals that are joined to two triangles, in ascending order. The triangles
/// have the corners of the quadrilateral, share one of its diagonals, and run the other way round.
/// A quadrilateral with such triangles on both diagonals is not joined, as these overlap.
/// Polyhedra have their faces as they are: only their triangles are joined.
/// @param boundary  faces with no other face of the same corners
/// Cost: O(n log n), if there are both quadrilaterals and triangles among them.
std::vector<JoinedQuad> find_joined_quads(const MeshData& data, const SourceFaces& faces,
                                          std::span<const SourceFace> boundary);

/// Returns the diagonals of each cell; empty if there are none.
std::vector<Diagonals> diagonals_of_cells(const MeshData& data, std::span<const JoinedQuad> joined);

/// Returns sentences such as "joined 64 quadrilaterals of hexahedra to two triangles of tetrahedra
/// each". Where the mesh has several regions, they name those of both sides.
std::vector<std::string> report_of_joins(const MeshData& data, std::span<const JoinedQuad> joined);

}  // namespace incise::topology
