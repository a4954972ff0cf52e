// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/error.h"

namespace incise::contact {

bool Contact::prepare(const physics::Model& model, double /*time*/, double dt) {
    solver_.clear();
    num_points_ = 0;
    tool_work_ = fracture_ = 0.0;
    restored_forces_.clear();
    last_dt_ = dt;
    tissue_.add_points(model, solver_);
    max_penetration_ = tissue_.max_penetration();
    for (ToolContact* tool : tools_) {
        tool->add_points(model, tissue_.surface(), dt, solver_);
        max_penetration_ = std::max(max_penetration_, tool->max_penetration());
        const ToolImpulse reported = tool->reported();
        tool->add(reported);
        fracture_energy_ += reported.fracture;
    }
    start_velocities_.clear();
    for (const NodeId node : solver_.nodes())
        start_velocities_.push_back(model.velocities()[node.index()]);
    if (!solver_.is_empty()) return true;
    // Nothing touches: the next touch begins without an impulse.
    take_impulses(dt);
    return false;
}

void Contact::take_impulses(double dt) {
    tissue_.take_impulses(solver_);
    for (ToolContact* tool : tools_) {
        const ToolImpulse done = tool->take_impulses(solver_, dt);
        tool->add(done);
        tool_work_ += done.work;
        fracture_ += done.fracture;
    }
}

/// Returns the work of the normal impulses of the step relative to the tools, J: with the mean of
/// the velocities before and after the step.
double Contact::normal_work(const physics::Model& model) const {
    double work = 0.0;
    for (std::size_t i = 0; i < solver_.size(); ++i) {
        const ContactPoint& point = solver_.point(i);
        const Vec3& impulse = solver_.impulse(i);
        if (point.is_bilateral || impulse.isZero(0.0)) continue;
        Vec3 sum = -2.0 * point.velocity;
        for (const NodeWeight& share : solver_.weights(i))
            sum += share.weight *
                   (start_velocities_[share.number] + model.velocities()[share.node.index()]);
        work += 0.5 * impulse.dot(point.normal) * sum.dot(point.normal);
    }
    return work;
}

void Contact::project(physics::Model& model, physics::ExplicitStep& step, double /*time*/,
                      double dt) {
    const auto masses = model.masses();
    inverse_masses_.resize(masses.size());
    for (const NodeId node : solver_.nodes()) {
        const std::size_t n = node.index();
        inverse_masses_[n].setZero();
        if (masses[n] == 0.0) continue;  // dead
        const auto* constraint_of = model.boundary().constraints().of_node(n);
        for (int c = 0; c < 3; ++c)
            if (!constraint_of || (*constraint_of)[static_cast<std::size_t>(c)] < 0)
                inverse_masses_[n][c] = step.response_to_impulses() / masses[n];
    }
    const double rest_step = model.structure().rest_stable_step();
    solver_.solve(model.velocities(), inverse_masses_, dt, rest_step, spare_energy_ >= 0.0);
    take_impulses(dt);
    impulses_.assign(masses.size(), Vec3::Zero());
    for (std::size_t i = 0; i < solver_.size(); ++i) {
        if (solver_.impulse(i).isZero(0.0)) continue;
        num_points_ += solver_.point(i).is_bilateral ? 0 : 1;
        for (const NodeWeight& share : solver_.weights(i))
            impulses_[share.node.index()] += share.weight * solver_.impulse(i);
    }
    step.give_impulses(model, impulses_);
    // What was taken is forgotten as fast as an overlap goes. A debt stays until it is paid.
    if (spare_energy_ > 0.0) spare_energy_ *= std::exp(-ContactSolver::correction * dt / rest_step);
    spare_energy_ -= normal_work(model);
}

std::vector<std::pair<VertexId, Vec3>> Contact::node_forces() const {
    if (last_dt_ == 0.0) return restored_forces_;
    auto forces = solver_.surface_impulses();
    for (auto& [node, force] : forces) force /= last_dt_;
    return forces;
}

void Contact::book_work(physics::Model& model) {
    const double loss = tool_work_ - model.energetics().impulse_work();
    model.energetics().record_work(loss, loss);
    dissipation_ += loss - fracture_;
    fracture_energy_ += fracture_;
}

void Contact::save(ArchiveWriter& ar) const {
    ar(dissipation_, fracture_energy_, num_points_, max_penetration_, spare_energy_, node_forces());
    tissue_.save(ar);
}

void Contact::restore(ArchiveReader& ar, const physics::Model& model,
                      const topology::BoundarySurface& surface) {
    ar(dissipation_, fracture_energy_, num_points_, max_penetration_, spare_energy_,
       restored_forces_);
    last_dt_ = 0.0;
    if (!std::isfinite(dissipation_) || !std::isfinite(fracture_energy_) ||
        !std::isfinite(spare_energy_))
        throw InputError("its contact has no sound energy");
    for (const auto& [node, force] : restored_forces_)
        if (!node.is_valid() || node.index() >= model.mesh().node_capacity() || !force.allFinite())
            throw InputError("its contact has forces on another body");
    tissue_.restore(ar, model, surface);
    solver_ = ContactSolver(tissue_.size());
}

}  // namespace incise::contact
