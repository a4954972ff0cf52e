// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <limits>
#include <sstream>

#include "incise/physics/body/motion_failure.h"
#include "incise/physics/solve/integrator.h"
#include "incise/physics/solve/solved_step.h"

namespace incise::physics {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double smallest_increment = 1.0 / 1024.0;  // of a load step
constexpr int few_iterations = 10;                   // the next increment may be larger

}  // namespace

bool Statics::equilibrate(Model& model, double time) {
    if (structure_version_ == model.version()) return false;
    step(model, time, 0.0);
    return true;
}

void Statics::require_equilibrium_of_free_components(const Model& model, double time) {
    if (newton_.free_components().empty()) return;
    next_outer_.resize(x_.size());
    model.boundary().outer_forces_at(x_, time, model.workers(), next_outer_);
    // Found anew, since constraints may have moved components that they hold in part.
    for (const FreeComponent& piece :
         find_free_components(model.fragments(), x_, model.boundary().constraints()))
        require_equilibrium(model.fragments(), model.mesh(), piece, x_, next_outer_);
}

Vec3 Statics::free_part(std::size_t node, const Vec3& force) const {
    Vec3 part = force;
    for (int c = 0; c < 3; ++c)
        if (!newton_.is_free(node, c)) part[c] = 0.0;
    return part;
}

void Statics::take_increment(Model& model, double from, double to) {
    double work = 0.0, released = 0.0;
    const double held = 1.0 - 0.5 * (from + to);
    for (std::size_t n = 0; n < x_.size(); ++n) {
        if (model.masses()[n] == 0.0) continue;  // dead
        const Vec3 displacement = x_[n] - model.positions()[n];
        const Vec3 net = elastic_[n] + outer_[n], next_net = next_elastic_[n] + next_outer_[n];
        reactions_[n] = free_part(n, next_net) - next_net;
        // The trapezoidal rule: forces are taken as linear in the displacement.
        work += 0.5 * (outer_[n] + next_outer_[n] + free_part(n, net) - net + reactions_[n])
                          .dot(displacement);
        released += held * imbalance_[n].dot(displacement);
    }
    const double taken = take_solved_step(model, x_, velocities_, reactions_, infinite);
    model.energetics().record_work(work, released + taken);
    std::swap(elastic_, next_elastic_);
    std::swap(outer_, next_outer_);
}

void Statics::step(Model& model, double time, double dt) {
    structure_version_ = model.version();
    newton_.follow(model);
    begin_solved_step(model);
    x_.assign(model.positions().begin(), model.positions().end());
    require_equilibrium_of_free_components(model, time + dt);

    const std::size_t num_nodes = x_.size();
    for (auto* field : {&velocities_, &elastic_, &reactions_, &holding_, &imbalance_})
        field->assign(num_nodes, Vec3::Zero());
    for (auto* field : {&outer_, &next_outer_}) field->resize(num_nodes);
    model.structure().elements().add_forces({x_, model.state().history(), infinite}, elastic_);
    model.boundary().outer_forces_at(x_, time, model.workers(), outer_);
    for (std::size_t n = 0; n < num_nodes; ++n)
        imbalance_[n] = free_part(n, elastic_[n] + outer_[n]);

    double done = 0.0, increment = 1.0;
    while (done < 1.0) {
        const double next = std::min(done + increment, 1.0), now = time + next * dt;
        for (std::size_t n = 0; n < num_nodes; ++n) holding_[n] = (next - 1.0) * imbalance_[n];
        x_.assign(model.positions().begin(), model.positions().end());
        const NewtonReport report =
            newton_.solve(model, {.time = now, .dt = infinite, .inertia = 0.0, .holding = holding_},
                          x_, next_elastic_);
        if (!report.has_converged) {
            increment *= 0.5;
            if (increment >= smallest_increment) continue;
            std::ostringstream text;
            text << "no equilibrium found at load time " << now << " s: " << report.iterations
                 << " iterations, " << report.imbalance << " N out of balance of " << report.scale
                 << " N, also with a " << 1.0 / smallest_increment
                 << "th of the load step; the tissue may have become unstable there";
            throw MotionFailure(FailureCause::no_equilibrium, text.str());
        }
        model.boundary().outer_forces_at(x_, now, model.workers(), next_outer_);
        take_increment(model, done, next);
        done = next;
        if (report.iterations <= few_iterations) increment *= 2.0;
    }
    require_equilibrium_of_free_components(model, time + dt);
}

}  // namespace incise::physics
