// What is at fault with what a world is given.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/body/constraints.h"
#include "incise/physics/body/loads.h"
#include "incise/sim/world.h"

namespace incise::sim {

/// Throws InputError for a shape that is none.
void require_sound(const ToolDef& def);
/// Throws InputError for nodes that are not there, or for none, and for curves that are none.
void require_sound(const physics::Constraint& constraint, const topology::Mesh& mesh);
/// Throws InputError unless a load acts on something that is there, with a finite value.
void require_sound(const physics::Load& load, const topology::Mesh& mesh);

/// Throws InputError for a value that no world can have, a material, constraint or load that is
/// none, and for indices of what is not there.
void require_sound(const WorldDef& def, const topology::Mesh& mesh);
void require_sound_num_threads(int n);

}  // namespace incise::sim
