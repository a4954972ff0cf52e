// What to do about what the library reports, in terms of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/physics/body/motion_failure.h"

namespace incise::scenario {

/// What the scenario of a run may change: the end of the failure's message.
std::string remedy_for(const physics::MotionFailure& failure);

}  // namespace incise::scenario
