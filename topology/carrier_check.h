// The check of the carriers of a body that was cut, before a mesh is built with them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Cuts can leave polyhedra that are turned inside out, as a share of the carrier. A cut keeps
/// its nodes 2e-3 of an edge from the ends of the edge. So two of its faces that nearly touch
/// can pass through each other by this distance, over a section of the carrier at the most:
/// 2e-3 of its volume. Where a cut is curved, its faces are chords, which are off it by the
/// height of the arc. In 960 random planes, blades, waves and spheres through coarse, jittered
/// bodies that made 4e-3. What is more than ten times as much is no result of cuts, but faces
/// that run the wrong way round. Below that, the volumes of a carrier's cells still add up to
/// its own.
inline constexpr double least_volume_of_part = 0.05;

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
