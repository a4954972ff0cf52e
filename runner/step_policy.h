// The choice of the steps of a run.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>

#include "incise/physics/body/model.h"
#include "incise/scenario/scenario.h"

namespace incise::runner {

/// The situation in which a step is chosen.
struct StepSituation {
    const scenario::Scenario& scenario;
    const physics::Model& model;
    double time;              ///< s
    double stop;              ///< s, the time of the next frame, or the end: no step goes beyond it
    double stable_step;       ///< s, in the present strain: sim::World::stable_step
    std::uint64_t num_steps;  ///< made so far
};

/// Chooses the end of the next step, s: later than `time`, and at most `stop`. The choice must
/// depend on the situation alone, so that a resumed run makes the same steps.
using StepPolicy = std::function<double(const StepSituation&)>;

/// Divides the time to the next stop evenly into steps below scenario::step_limit(). This is the
/// policy of the program. Throws as step_limit().
double even_steps(const StepSituation& situation);

}  // namespace incise::runner
