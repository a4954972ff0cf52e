// Builds what a scenario describes: the mesh, its materials, what holds and loads it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "physics/model.h"
#include "sim/scenario.h"
#include "topology/mesh.h"

namespace incise::sim {

/// Reads or makes the scenario's mesh. Warnings name the file.
/// Throws InputError with every problem found, each line naming the file.
topology::BuiltMesh build_mesh(const MeshSpec& spec);

/// Which region has which material. Warns of regions that the mesh does not have.
/// Throws InputError for a region of the mesh without material.
physics::MaterialTable build_materials(const std::vector<MaterialSpec>& specs,
                                       const topology::Mesh& mesh,
                                       std::vector<std::string>& warnings);

/// Gravity, damping, supports and loads. Throws InputError for empty selections.
physics::Surroundings build_surroundings(const Scenario& scenario, const topology::Mesh& mesh);

}  // namespace incise::sim
