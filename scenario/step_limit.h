// The upper limit of the time step of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"

namespace incise::scenario {

/// Returns the longest step that the scenario allows for its body, s.
/// @param scenario   the scenario; an end time that is infinite means none
/// @param model      the body in its present state
/// @param stable     the stable step of the body in its present strain, s; automatic steps follow
///                   it, and one of fixed length is divided by the world where it is above it
/// @param num_steps  number of steps that the run has made
/// Throws PhysicsError if an explicit step of fixed length is above the stable step at rest. Throws
/// BodyError if the run would need more than 1e10 steps to its end, or without an end for a second,
/// but PhysicsError if `num_steps` is not 0.
/// If `num_steps` is 0, the messages begin with the location of the faulty key.
double step_limit(const Scenario& scenario, const physics::Model& model, double stable,
                  std::uint64_t num_steps = 0);

}  // namespace incise::scenario
