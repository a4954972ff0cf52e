// What is told about a mesh that was made.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::tetmesh {

/// Returns the counts, the volumes and the quality of a mesh, in lines that end with a line feed.
/// The least altitude is that which limits the time step of a run.
std::string report_of(const std::string& name, const topology::MeshData& mesh);

/// Throws InputError if the volume of the mesh differs from that of the body by more than a
/// quarter, as happens where the body is thinner than the edges.
void refuse_other_volume(const topology::MeshData& mesh, const std::map<int, double>& volumes);

/// Returns warnings about regions that the mesh has lost, or whose volume differs from that of the
/// body by more than a tenth.
std::vector<std::string> losses_of(const topology::MeshData& mesh,
                                   const std::map<int, double>& volumes);

}  // namespace incise::tetmesh
