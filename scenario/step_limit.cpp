// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/step_limit.h"

#include <cmath>
#include <sstream>

#include "incise/base/error.h"
#include "incise/scenario/body_problems.h"

namespace incise::scenario {

namespace {

[[noreturn]] void refuse_unstable(const DynamicsSpec& dynamics, double stable,
                                  std::uint64_t num_steps) {
    std::ostringstream text;
    text << "dynamics.time_step of " << *dynamics.time_step << " s is above the stable step of "
         << stable << " s";
    if (num_steps > 0) text << " that the edits have left";
    text << ": use a smaller one, or time_step = \"auto\"";
    throw PhysicsError(located(num_steps == 0 ? dynamics.time_step_location : "", text.str()));
}

[[noreturn]] void refuse_endless(const DynamicsSpec& dynamics, double limit,
                                 const physics::Model& model, std::uint64_t num_steps) {
    std::ostringstream text;
    text << "steps of " << limit << " s would take more than 1e10 of them ";
    if (std::isfinite(dynamics.end_time))
        text << "to the end at " << dynamics.end_time << " s: lower dynamics.end_time or ";
    else
        text << "for a second: ";
    if (dynamics.time_step)
        text << "raise dynamics.time_step";
    else
        text << "check shape and material of element "
             << model.mesh().label(model.structure().limiting_cell())
             << ", which is the smallest or stiffest for its mass";
    if (num_steps > 0) throw PhysicsError(text.str());  // the cause is an edit, not the scenario
    throw BodyError(dynamics.time_step ? dynamics.time_step_location : dynamics.end_time_location,
                    text.str());
}

}  // namespace

double step_limit(const Scenario& scenario, const physics::Model& model, double stable,
                  std::uint64_t num_steps) {
    const DynamicsSpec& dynamics = scenario.dynamics;
    if (dynamics.mode == Mode::statics) {
        if (dynamics.steps) return dynamics.end_time / *dynamics.steps;
        return scenario.output.interval > 0.0 ? scenario.output.interval : dynamics.end_time;
    }
    const bool is_explicit = dynamics.integrator == TimeIntegrator::semi_implicit_euler;
    const double at_rest = model.structure().rest_stable_step();
    const double limit = dynamics.time_step ? *dynamics.time_step : dynamics.safety * stable;
    if (is_explicit && dynamics.time_step && !(limit <= at_rest))
        refuse_unstable(dynamics, at_rest, num_steps);
    // More steps would take years. In the end, rounding would keep the time from increasing.
    constexpr double max_steps = 1e10;
    const double duration = std::isfinite(dynamics.end_time) ? dynamics.end_time : 1.0;
    if (!dynamics.is_endless && !(limit * max_steps >= duration))
        refuse_endless(dynamics, limit, model, num_steps);
    return limit;
}

}  // namespace incise::scenario
