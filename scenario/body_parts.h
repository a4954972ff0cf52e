// Makes a material, a constraint or a load of a body from its section.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/body/constraints.h"
#include "incise/physics/body/loads.h"
#include "incise/physics/laws/material.h"
#include "incise/scenario/scenario.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// @pre  the section is sound
physics::Material build_material(const MaterialSpec& spec);
/// Throws InputError if the section selects nothing.
physics::Constraint build_constraint(const ConstraintSpec& spec, const topology::Mesh& mesh);
physics::Load build_load(const LoadSpec& spec, const topology::Mesh& mesh);

}  // namespace incise::scenario
