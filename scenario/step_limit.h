// How long a time step may be.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"

namespace incise::scenario {

/// The longest step that the scenario allows its body, s.
/// @param num_steps  done already
/// Throws PhysicsError for a fixed step above the stable one, and BodyError for steps so short that
/// the run would never end, PhysicsError if only the edits of a run have made them so. Before the
/// first step both begin with the location of what is at fault.
double step_limit(const Scenario& scenario, const physics::Model& model,
                  std::uint64_t num_steps = 0);

}  // namespace incise::scenario
