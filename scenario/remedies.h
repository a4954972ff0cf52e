// Advice for users on failures of a run, in terms of the scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/physics/body/motion_failure.h"

namespace incise::scenario {

/// Returns the end of the message of a failure: what the user can change in the scenario.
std::string remedy_for(const physics::MotionFailure& failure);

}  // namespace incise::scenario
