// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/step_policy.h"

#include <cmath>

#include "incise/scenario/step_limit.h"

namespace incise::runner {

double even_steps(const StepSituation& situation) {
    // A tiny excess over a whole number of steps is due to rounding and needs no further step.
    constexpr double rounding = 1e-9;
    const auto& [scenario, model, time, stop, stable_step, num_steps] = situation;
    const double limit = scenario::step_limit(scenario, model, stable_step, num_steps);
    const double steps = std::ceil((stop - time) / limit * (1.0 - rounding));
    return steps <= 1.0 ? stop : time + (stop - time) / steps;
}

}  // namespace incise::runner
