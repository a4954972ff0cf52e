// From a scenario's `where` to the nodes, faces and elements of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "sim/scenario.h"
#include "topology/mesh.h"

namespace incise::sim {

/// Nodes for which everything given holds, at rest; in a region are all nodes of its elements, also
/// those that it shares with another. Ascending.
std::vector<topology::NodeId> select_nodes(const topology::Mesh& mesh, const Selection& where);

/// Faces of the boundary whose element is in `where.regions` and for all of whose nodes the rest
/// holds; ascending.
std::vector<topology::FaceId> select_faces(const topology::Mesh& mesh, const Selection& where);

/// Elements that are in `where.regions` and for all of whose nodes the rest holds; ascending.
std::vector<topology::ElementId> select_elements(const topology::Mesh& mesh,
                                                 const Selection& where);

/// Throws InputError that says where the mesh is, if `count` is zero.
/// @param what  such as "constraint 'clamp'"
/// @param things  such as "node"
void require_selected(std::size_t count, const topology::Mesh& mesh, const std::string& what,
                      const std::string& things);

}  // namespace incise::sim
