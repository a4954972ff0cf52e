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
    for (auto& [number, tool] : tools_) {
        if (auto* rigid = std::get_if<RigidContact>(&tool.contact)) rigid->forget_surface();
        if (auto* grasp = std::get_if<GraspContact>(&tool.contact)) grasp->follow(model);
    }
}

Contact::Tool& Contact::tool_of(std::size_t tool, const cutting::ToolShape& shape) {
    const auto known = tools_.find(tool);
    if (known != tools_.end()) return known->second;
    if (const auto* grasper = std::get_if<cutting::Grasper>(&shape))
        return tools_.try_emplace(tool, Tool{GraspContact(*grasper, size())}).first->second;
    return tools_.try_emplace(tool, Tool{RigidContact(std::get<cutting::Probe>(shape), size())})
        .first->second;
}

void Contact::move_tool(std::size_t tool, const cutting::ToolShape& shape, const Pose& before,
                        const Pose& after) {
    std::visit([&](auto& contact) { contact.move(before, after); }, tool_of(tool, shape).contact);
}

void Contact::close(std::size_t tool, const cutting::Grasper& grasper, const physics::Model& model,
                    const Pose& pose) {
    std::get<GraspContact>(tool_of(tool, grasper).contact).close(model, tissue_.triangles(), pose);
}

void Contact::open(std::size_t tool) {
    const auto it = tools_.find(tool);
    if (it != tools_.end()) std::get<GraspContact>(it->second.contact).open();
}

std::size_t Contact::num_held(std::size_t tool) const {
    const auto it = tools_.find(tool);
    if (it == tools_.end()) return 0;
    const auto* grasp = std::get_if<GraspContact>(&it->second.contact);
    return grasp ? grasp->num_held() : 0;
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
        if (auto* grasp = std::get_if<GraspContact>(&tool.contact)) {
            grasp->add_points(model, dt, solver_);
            continue;
        }
        auto& rigid = std::get<RigidContact>(tool.contact);
        rigid.add_points(model, tissue_.triangles(), dt, solver_);
        max_penetration_ = std::max(max_penetration_, rigid.max_penetration());
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
        const ToolImpulse done = std::visit(
            [&](auto& contact) { return contact.take_impulses(solver_, dt); }, tool.contact);
        tool.impulse += done;
        tool_work_ += done.work;
    }
    impulses_.assign(masses.size(), Vec3::Zero());
    for (std::size_t i = 0; i < solver_.size(); ++i) {
        if (solver_.impulse(i).isZero(0.0)) continue;
        num_points_ += solver_.point(i).is_held ? 0 : 1;
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

void Contact::require_tools(std::span<const cutting::ToolShape* const> shapes) const {
    for (const auto& [number, tool] : tools_) {
        const bool is_grasp = std::holds_alternative<GraspContact>(tool.contact);
        if (number >= shapes.size() || !cutting::feels_force(*shapes[number]) ||
            is_grasp != std::holds_alternative<cutting::Grasper>(*shapes[number]))
            throw InputError("its contact has tools that it does not have");
    }
}

void Contact::save(ArchiveWriter& ar) const {
    ar(dissipation_, num_points_, max_penetration_);
    tissue_.save(ar);
    ar(static_cast<std::uint64_t>(tools_.size()));
    for (const auto& [number, tool] : tools_) {
        ar(static_cast<std::uint64_t>(number), static_cast<std::uint64_t>(tool.contact.index()));
        std::visit([&](const auto& contact) { contact.save(ar); }, tool.contact);
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
        if (ar.read<std::uint64_t>() == 0) {
            RigidContact rigid({}, size());
            rigid.restore(ar, tissue_.triangles().size());
            tools_.insert_or_assign(number, Tool{std::move(rigid)});
        } else {
            GraspContact grasp({}, size());
            grasp.restore(ar, model);
            tools_.insert_or_assign(number, Tool{std::move(grasp)});
        }
    }
}

}  // namespace incise::contact
