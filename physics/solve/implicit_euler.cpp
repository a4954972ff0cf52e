// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sstream>

#include "incise/physics/body/motion_failure.h"
#include "incise/physics/solve/integrator.h"
#include "incise/physics/solve/solved_step.h"

namespace incise::physics {

void ImplicitEuler::step(Model& model, double time, double dt) {
    begin_solved_step(model);
    newton_.follow(model);
    substep(model, time, dt, 0);
}

void ImplicitEuler::substep(Model& model, double time, double dt, int halvings) {
    const auto before = model.positions(), v = model.velocities();
    const double damping = model.boundary().damping(), slowed = 1.0 + damping * dt;
    x_.assign(before.begin(), before.end());
    predicted_positions_.resize(x_.size());
    for (std::size_t n = 0; n < x_.size(); ++n)
        predicted_positions_[n] = x_[n] + dt / slowed * v[n];
    const NewtonReport report = newton_.solve(model,
                                              {.time = time + dt,
                                               .dt = dt,
                                               .inertia = slowed / (dt * dt),
                                               .predicted_positions = predicted_positions_},
                                              x_, elastic_);
    if (!report.has_converged) {
        constexpr int most_halvings = 10;
        if (halvings < most_halvings) {
            substep(model, time, 0.5 * dt, halvings + 1);
            substep(model, time + 0.5 * dt, 0.5 * dt, halvings + 1);
            return;
        }
        std::ostringstream text;
        text << "the implicit step to t = " << time + dt
             << " s has no solution within reach: " << report.iterations << " iterations, "
             << report.imbalance << " N out of balance of " << report.scale
             << " N, also with a step of " << dt << " s";
        throw MotionFailure(FailureCause::no_implicit_step, text.str());
    }

    outer_.resize(x_.size());
    model.boundary().outer_forces_at(x_, time + dt, model.workers(), outer_);
    velocities_.assign(v.begin(), v.end());
    reactions_.assign(x_.size(), Vec3::Zero());
    double work = 0.0, dissipated = 0.0;
    for (std::size_t n = 0; n < x_.size(); ++n) {
        const double mass = model.masses()[n];
        if (mass == 0.0) continue;  // dead
        const Vec3 displacement = x_[n] - before[n], v_new = displacement / dt,
                   change = v_new - v[n];
        const Vec3 force = elastic_[n] + outer_[n];
        work += outer_[n].dot(displacement);
        dissipated += damping * mass * dt * v_new.squaredNorm() - elastic_[n].dot(displacement);
        for (int c = 0; c < 3; ++c) {
            const double swing = 0.5 * mass * change[c] * change[c];
            if (newton_.is_free(n, c)) {
                dissipated += swing;
                continue;
            }
            // The inertial part of the reaction works at the mean velocity, as in
            // explicit steps.
            reactions_[n][c] = mass * (change[c] / dt + damping * v_new[c]) - force[c];
            work += reactions_[n][c] * displacement[c] - swing;
        }
        velocities_[n] = v_new;
    }
    const double energy = model.energetics().elastic_energy();
    take_solved_step(model, x_, velocities_, reactions_, dt);
    // What the elements do not keep of the work on them is taken by viscosity and by the method.
    model.energetics().record_work(work,
                                   dissipated - (model.energetics().elastic_energy() - energy));
}

}  // namespace incise::physics
