// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/error.h"

namespace incise::contact {

void Contact::follow(const physics::Model& model, const topology::BoundarySurface& surface) {
    tissue_.know_surface(model, surface);
    for (auto& [number, tool] : tools_) tool.contact.forget_surface();
}

void Contact::move_tool(std::size_t tool, const cutting::Probe& probe, const Pose& before,
                        const Pose& after) {
    const auto it = tools_.try_emplace(tool, Tool{RigidContact(probe, tissue_.size())}).first;
    it->second.contact.move(before, after);
}

ToolImpulse Contact::take_impulse(std::size_t tool) {
    const auto it = tools_.find(tool);
    return it == tools_.end() ? ToolImpulse() : std::exchange(it->second.impulse, {});
}

bool Contact::prepare(const physics::Model& model, double /*time*/, double dt) {
    solver_.clear();
    num_points_ = 0;
    tool_work_ = 0.0;
    tissue_.add_points(model, solver_);
    max_penetration_ = tissue_.max_penetration();
    for (auto& [number, tool] : tools_) {
        tool.contact.add_points(model, tissue_.triangles(), dt, solver_);
        max_penetration_ = std::max(max_penetration_, tool.contact.max_penetration());
    }
    return !solver_.is_empty();
}

void Contact::project(physics::Model& model, double /*time*/, double dt) {
    const auto masses = model.masses();
    inverse_masses_.assign(masses.size(), Vec3::Zero());
    for (std::size_t n = 0; n < masses.size(); ++n) {
        if (masses[n] == 0.0) continue;  // dead
        const auto* constraint_of = model.constraints().of_node(n);
        for (int c = 0; c < 3; ++c)
            if (!constraint_of || (*constraint_of)[static_cast<std::size_t>(c)] < 0)
                inverse_masses_[n][c] = model.response_to_impulses() / masses[n];
    }
    solver_.solve(model.velocities(), inverse_masses_, dt, model.rest_stable_step());
    tissue_.take_impulses(solver_);
    for (auto& [number, tool] : tools_) {
        const ToolImpulse done = tool.contact.take_impulses(solver_);
        tool.impulse += done;
        tool_work_ += done.work;
    }
    impulses_.assign(masses.size(), Vec3::Zero());
    for (std::size_t i = 0; i < solver_.size(); ++i) {
        if (solver_.impulse(i).isZero(0.0)) continue;
        ++num_points_;
        for (const Share& share : solver_.shares(i))
            impulses_[share.node.index()] += share.weight * solver_.impulse(i);
    }
    model.give_impulses(impulses_);
}

void Contact::book_work(physics::Model& model) {
    const double loss = tool_work_ - model.impulse_work();
    model.record_work(loss, loss);
    dissipation_ += loss;
}

void Contact::save(ArchiveWriter& ar) const {
    ar(dissipation_, num_points_, max_penetration_);
    tissue_.save(ar);
    ar(static_cast<std::uint64_t>(tools_.size()));
    for (const auto& [number, tool] : tools_) {
        ar(static_cast<std::uint64_t>(number));
        tool.contact.save(ar);
    }
}

void Contact::restore(ArchiveReader& ar, const physics::Model& model,
                      const topology::BoundarySurface& surface) {
    ar(dissipation_, num_points_, max_penetration_);
    if (!std::isfinite(dissipation_)) throw InputError("its contact has no sound energy");
    tissue_.restore(ar, model, surface);
    solver_ = ContactSolver(tissue_.size());
    for (auto count = ar.read<std::uint64_t>(); count > 0; --count) {
        const auto number = ar.read<std::uint64_t>();
        Tool tool{RigidContact({}, tissue_.size())};
        tool.contact.restore(ar, tissue_.triangles().size());
        tools_.insert_or_assign(number, std::move(tool));
    }
}

}  // namespace incise::contact
