// Advice for users on failures of a run, in terms of the scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "incise/physics/body/motion_failure.h"
#include "incise/physics/elements/element_store.h"
#include "incise/scenario/scenario.h"
#include "incise/topology/mesh_data.h"

namespace incise::scenario {

/// What a user of the program can do about points that are not joined.
topology::WeldAdvice weld_advice();

/// What a user of the program can do about cells of higher order.
std::string linear_advice();

/// Returns the end of the message of a material that does not suit an element.
/// @param material  as the scenario gives it; null if it gives none
std::string remedy_for(const physics::UnsuitableMaterial& misfit, const MaterialSpec* material);

/// Returns the end of the message of a failure: what the user can change in the scenario.
std::string remedy_for(const physics::MotionFailure& failure);

}  // namespace incise::scenario
