// The check of the faces of polyhedra, before a mesh is built with them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <string>

#include "incise/topology/mesh_data.h"
#include "incise/topology/source_faces.h"

namespace incise::topology {

/// Returns why MeshData::faces cannot be the faces of the polyhedra; empty if they can be. Numbers
/// of points are not checked: see the corners of the cells.
/// @pre  the offsets of `data` are sound
/// Cost: O(#faces of polyhedra).
std::string fault_of_face_lists(const MeshData& data);

/// Returns why the faces of a polyhedron do not bound a ball, with a remedy; empty if they do: each
/// edge joins two faces, which pass it in opposite directions, the faces at a corner follow each
/// other round it, all faces hang together, and corners less edges plus faces are 2.
/// Cost: O(n log n) in the number of corners of its faces.
std::string fault_of_polyhedron(const MeshData& data, const SourceFaces& faces, std::size_t c);

}  // namespace incise::topology
