// A step whose end a solver has found: an implicit step or an increment of statics.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/physics/body/model.h"

namespace incise::physics {

/// Begins a step of a solver that finds its end itself. The step may consist of several parts.
void begin_solved_step(Model& model);

/// Moves to the end of a step, or of a part of it, and advances the history. Returns the energy
/// that viscosity dissipated, J. Work and forces stay as they are.
/// @param model       the body
/// @param positions   at the end, m, by node id
/// @param velocities  at the end, m/s, by node id
/// @param reactions   forces of the constraints on their nodes, N, by node id; zero in free
///                    components
/// @param dt          time since the present state, s; infinite in statics
/// @pre  begin_solved_step() was called before the first part
double take_solved_step(Model& model, std::span<const Vec3> positions,
                        std::span<const Vec3> velocities, std::span<const Vec3> reactions,
                        double dt);

}  // namespace incise::physics
