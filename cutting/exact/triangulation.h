// The triangles of a face that a cut has made.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <span>
#include <utility>

#include "incise/topology/mesh.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

/// Divides a face into triangles, on both sides, by ears: the one of the best shape first, as seen
/// along the mean normal at rest. Both cells at the face have no other edge between the ends of a
/// new one. Where ears are not possible for this reason, a node in the middle makes the rest.
/// @param mesh      the body
/// @param edit      the edit that is going on
/// @param face      the face
/// @param on_edge   called with the ends of each new edge
/// @param on_node   called with a new node, and with what it is the mean of
void triangulate(
    const topology::Mesh& mesh, topology::MeshEdit& edit, FaceId face,
    const std::function<void(VertexId, VertexId)>& on_edge,
    const std::function<void(VertexId, std::span<const std::pair<VertexId, double>>)>& on_node);

}  // namespace incise::cutting
