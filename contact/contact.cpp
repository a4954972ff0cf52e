// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/error.h"

namespace incise::contact {

namespace {

/// Returns the alternative of Contact::Tool::contact for a shape that feels a force.
std::size_t kind_of(const cutting::ToolShape& shape) {
    if (std::holds_alternative<cutting::Grasper>(shape)) return 1;
    if (std::holds_alternative<cutting::Suture>(shape)) return 2;
    return std::holds_alternative<cutting::Blade>(shape) ? 3 : 0;
}

}  // namespace

void Contact::follow(const physics::Model& model, const topology::BoundarySurface& surface) {
    tissue_.know_surface(model, surface);
    for (auto& [number, tool] : tools_)
        std::visit([&](auto& contact) { contact.follow(model); }, tool.contact);
}

Contact::Tool& Contact::tool_of(std::size_t tool, const cutting::ToolShape& shape) {
    const auto known = tools_.find(tool);
    if (known != tools_.end()) return known->second;
    const auto come = [&](auto contact) -> Tool& {
        return tools_.try_emplace(tool, Tool{std::move(contact)}).first->second;
    };
    if (const auto* grasper = std::get_if<cutting::Grasper>(&shape))
        return come(GraspContact(*grasper, size()));
    if (const auto* suture = std::get_if<cutting::Suture>(&shape))
        return come(SutureContact(*suture, size()));
    if (const auto* blade = std::get_if<cutting::Blade>(&shape))
        return come(BladeContact(*blade, size()));
    return come(RigidContact(std::get<cutting::Probe>(shape), size()));
}

void Contact::move_tool(std::size_t tool, const cutting::ToolShape& shape, const Pose& before,
                        const Pose& after) {
    std::visit([&](auto& contact) { contact.move(before, after); }, tool_of(tool, shape).contact);
}

void Contact::move_blade(std::size_t tool, const cutting::Blade& blade, const physics::Model& model,
                         const Pose& before, const Pose& after, const TissueAt& tissue_at) {
    std::get<BladeContact>(tool_of(tool, blade).contact).move(model, before, after, tissue_at);
}

void Contact::tie(std::size_t tool, const cutting::Suture& suture, const physics::Model& model) {
    std::get<SutureContact>(tool_of(tool, suture).contact).tie(model);
}

void Contact::draw(std::size_t tool, double length) {
    const auto it = tools_.find(tool);
    if (it != tools_.end()) std::get<SutureContact>(it->second.contact).draw(length);
}

double Contact::thread_length(std::size_t tool) const {
    const auto it = tools_.find(tool);
    return it == tools_.end() ? 0.0 : std::get<SutureContact>(it->second.contact).length();
}

void Contact::close(std::size_t tool, const cutting::Grasper& grasper, const physics::Model& model,
                    const Pose& pose) {
    std::get<GraspContact>(tool_of(tool, grasper).contact)
        .close(model, tissue_.surface().triangles, pose);
}

void Contact::open(std::size_t tool) {
    const auto it = tools_.find(tool);
    if (it != tools_.end()) std::get<GraspContact>(it->second.contact).open();
}

std::size_t Contact::num_held(std::size_t tool) const {
    const auto it = tools_.find(tool);
    if (it == tools_.end()) return 0;
    if (const auto* grasp = std::get_if<GraspContact>(&it->second.contact))
        return grasp->num_held();
    const auto* suture = std::get_if<SutureContact>(&it->second.contact);
    return suture ? suture->num_held() : 0;
}

ToolImpulse Contact::take_impulse(std::size_t tool) {
    const auto it = tools_.find(tool);
    return it == tools_.end() ? ToolImpulse() : std::exchange(it->second.impulse, {});
}

bool Contact::prepare(const physics::Model& model, double /*time*/, double dt) {
    solver_.clear();
    num_points_ = 0;
    tool_work_ = fracture_ = 0.0;
    restored_forces_.clear();
    last_dt_ = dt;
    tissue_.add_points(model, solver_);
    max_penetration_ = tissue_.max_penetration();
    for (auto& [number, tool] : tools_) {
        std::visit(
            [&](auto& contact) {
                contact.add_points(model, tissue_.surface(), dt, solver_);
                max_penetration_ = std::max(max_penetration_, contact.max_penetration());
            },
            tool.contact);
        if (const auto* blade = std::get_if<BladeContact>(&tool.contact)) {
            tool.impulse += blade->reported();
            fracture_energy_ += blade->reported().fracture;
        }
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
    for (auto& [number, tool] : tools_) {
        const ToolImpulse done = std::visit(
            [&](auto& contact) { return contact.take_impulses(solver_, dt); }, tool.contact);
        tool.impulse += done;
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
        if (point.is_held || impulse.isZero(0.0)) continue;
        Vec3 sum = -2.0 * point.velocity;
        for (const Share& share : solver_.shares(i))
            sum += share.weight *
                   (start_velocities_[share.number] + model.velocities()[share.node.index()]);
        work += 0.5 * impulse.dot(point.normal) * sum.dot(point.normal);
    }
    return work;
}

void Contact::project(physics::Model& model, double /*time*/, double dt) {
    const auto masses = model.masses();
    inverse_masses_.resize(masses.size());
    for (const NodeId node : solver_.nodes()) {
        const std::size_t n = node.index();
        inverse_masses_[n].setZero();
        if (masses[n] == 0.0) continue;  // dead
        const auto* constraint_of = model.constraints().of_node(n);
        for (int c = 0; c < 3; ++c)
            if (!constraint_of || (*constraint_of)[static_cast<std::size_t>(c)] < 0)
                inverse_masses_[n][c] = model.response_to_impulses() / masses[n];
    }
    const double rest_step = model.rest_stable_step();
    solver_.solve(model.velocities(), inverse_masses_, dt, rest_step, spare_energy_ >= 0.0);
    take_impulses(dt);
    impulses_.assign(masses.size(), Vec3::Zero());
    for (std::size_t i = 0; i < solver_.size(); ++i) {
        if (solver_.impulse(i).isZero(0.0)) continue;
        num_points_ += solver_.point(i).is_held ? 0 : 1;
        for (const Share& share : solver_.shares(i))
            impulses_[share.node.index()] += share.weight * solver_.impulse(i);
    }
    model.give_impulses(impulses_);
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
    const double loss = tool_work_ - model.impulse_work();
    model.record_work(loss, loss);
    dissipation_ += loss - fracture_;
    fracture_energy_ += fracture_;
}

void Contact::take_shapes(std::span<const cutting::ToolShape* const> shapes) {
    for (auto& [number, tool] : tools_) {
        if (number >= shapes.size() || !cutting::feels_force(*shapes[number]) ||
            kind_of(*shapes[number]) != tool.contact.index())
            throw InputError("its contact has tools that it does not have");
        const cutting::ToolShape& shape = *shapes[number];
        std::visit([&](auto& contact) { contact.take_shape(shape); }, tool.contact);
    }
}

void Contact::save(ArchiveWriter& ar) const {
    ar(dissipation_, fracture_energy_, num_points_, max_penetration_, spare_energy_, node_forces());
    tissue_.save(ar);
    ar(static_cast<std::uint64_t>(tools_.size()));
    for (const auto& [number, tool] : tools_) {
        ar(static_cast<std::uint64_t>(number), static_cast<std::uint64_t>(tool.contact.index()));
        std::visit([&](const auto& contact) { contact.save(ar); }, tool.contact);
    }
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
    for (auto count = ar.read<std::uint64_t>(); count > 0; --count) {
        const auto number = ar.read<std::uint64_t>();
        const auto kind = ar.read<std::uint64_t>();
        const auto come = [&](auto contact, const auto&... arguments) {
            contact.restore(ar, arguments...);
            tools_.insert_or_assign(number, Tool{std::move(contact)});
        };
        if (kind == 0) come(RigidContact({}, size()), tissue_.surface().triangles.size());
        if (kind == 1) come(GraspContact({}, size()), model);
        if (kind == 2) come(SutureContact({}, size()), model);
        if (kind == 3) come(BladeContact({}, size()));
        if (kind > 3) throw InputError("its contact has a tool of an unknown kind");
    }
}

}  // namespace incise::contact
