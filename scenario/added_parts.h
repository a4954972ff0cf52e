// Constraints, loads and materials that a program gives to a world which runs.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/physics/body/constraints.h"
#include "incise/physics/body/loads.h"
#include "incise/physics/laws/material.h"
#include "incise/scenario/document.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Build a constraint and a load from tables with the keys of [[constraint]] and [[load]], without
/// name. Selections are of the mesh as it is, by rest positions; times are those of the world.
/// Throw InputError with all problems, one a line, and if nothing is selected.
physics::Constraint build_added_constraint(const Value& definition, const std::string& name,
                                           const topology::Mesh& mesh,
                                           std::vector<std::string>& warnings);
physics::Load build_added_load(const Value& definition, const std::string& name,
                               const topology::Mesh& mesh, std::vector<std::string>& warnings);

struct AddedMaterial {
    physics::Material material;
    std::vector<int> regions;   ///< empty: all
    std::optional<Vec3> fibre;  ///< direction at rest, of unit length
};
/// Builds a material from a table with the keys of [[material]], but fibre_array.
/// Throws InputError with all problems, one a line.
AddedMaterial build_added_material(const Value& definition, std::vector<std::string>& warnings);

}  // namespace incise::scenario
