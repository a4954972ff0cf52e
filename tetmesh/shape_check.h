// Where the mesh of a body has another shape than the body: gaps that are closed, thin parts that
// are lost, parts that are joined.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"
#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// Returns warnings, each with a place, the width there and a remedy. The surface of the mesh has
/// to be near each point of that of the body, and between the same regions. It has to have as many
/// closed parts and as many handles, where the body tells them.
/// @param edge  length of edges on surfaces, in the unit of the mesh
/// Cost: some microseconds a face of the surface.
std::vector<std::string> differences_of_shape(const topology::MeshData& mesh, const BodyShape& body,
                                              double edge);

}  // namespace incise::tetmesh
