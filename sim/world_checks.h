// Checks of the definition of a world and of its parts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/body/constraints.h"
#include "incise/physics/body/loads.h"
#include "incise/sim/world.h"

namespace incise::sim {

/// Throws InputError if the constraint has no nodes, if a node does not exist, or if a curve is
/// invalid.
void require_sound(const physics::Constraint& constraint, const topology::Mesh& mesh);
/// Throws InputError unless the load acts on something that exists, with a finite value.
void require_sound(const physics::Load& load, const topology::Mesh& mesh);

/// Throws InputError for a value out of range, for an invalid material, constraint or load, and for
/// an index out of range.
/// @param what  what the material is called
void require_sound(const physics::Material& material, const std::string& what);
void require_sound_gravity(const Vec3& gravity);
void require_sound_damping(double damping);
void require_sound(const WorldDef& def, const topology::Mesh& mesh);
/// Throws InputError unless `n` is at least 1.
void require_sound_num_threads(int n);

}  // namespace incise::sim
