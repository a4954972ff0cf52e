// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/boundary.h"

#include <cmath>
#include <sstream>
#include <utility>

#include "incise/base/error.h"

namespace incise::physics {

std::vector<VertexId> constrained_by(const topology::Mesh& mesh,
                                     std::span<const Constraint> constraints) {
    std::vector<VertexId> nodes;
    for (const Constraint& constraint : constraints) {
        constraint.require_fit(mesh);
        if (!constraint.grip.is_empty()) continue;
        for (const VertexSet::Member& member : constraint.nodes.members())
            nodes.push_back(member.node);
    }
    return nodes;
}

BoundaryConditions read_boundary_conditions(const topology::Mesh& mesh, ArchiveReader& ar) {
    BoundaryConditions conditions;
    ar(conditions.gravity, conditions.damping, conditions.constraints, conditions.loads);
    for (const Constraint& constraint : conditions.constraints) constraint.require_fit(mesh);
    for (const Load& load : conditions.loads) load.require_fit(mesh);
    return conditions;
}

Boundary::Boundary(Structure& structure, const State& state, BoundaryConditions conditions)
    : structure_(structure),
      state_(state),
      damping_(conditions.damping),
      constraints_(view(), std::move(conditions.constraints)),
      loads_(conditions.gravity, std::move(conditions.loads), view()),
      outer_forces_(structure.masses().size(), Vec3::Zero()),
      reactions_(constraints_.size()) {
    constrain_fragments();
}

void Boundary::constrain_fragments() {
    structure_.fragments_.constrain(constrained_by(structure_.mesh(), constraints_.all()));
}

void Boundary::add_constraint(Constraint constraint) {
    constraints_.add(view(), std::move(constraint));
    constrain_fragments();
    reactions_.emplace_back();
    ++version_;
}

void Boundary::set_constraint(std::size_t i, Constraint constraint) {
    std::vector<Constraint> all(constraints_.all().begin(), constraints_.all().end());
    all[i] = std::move(constraint);
    constraints_ = Constraints(view(), std::move(all));
    constrain_fragments();
    ++version_;
}

void Boundary::remove_constraint(std::size_t i) {
    constraints_.remove(view(), i);
    constrain_fragments();
    reactions_.erase(reactions_.begin() + static_cast<std::ptrdiff_t>(i));
    ++version_;
}

void Boundary::add_load(Load load) {
    loads_.add(std::move(load), view());
    ++version_;
}

void Boundary::set_load(std::size_t i, Load load) {
    loads_.set(i, std::move(load), view());
    ++version_;
}

void Boundary::remove_load(std::size_t i) {
    loads_.remove(i);
    ++version_;
}

void Boundary::sum_stiffness() {
    for (const NodeId n : structure_.fragments().nodes()) structure_.gather(n, stiffness_bound(n));
}

void Boundary::add_force_term(std::unique_ptr<ForceTerm> term) {
    term->update(view());
    for (const NodeId n : structure_.fragments().nodes())
        if (const double bound = term->stiffness_bound(n);
            !(bound >= 0.0 && std::isfinite(bound))) {
            std::ostringstream text;
            text << "a force term bounds its stiffness at the node that is at rest at "
                 << structure_.fragments().rest_position(n).transpose() << " by " << bound
                 << " N/m: it must be finite, and 0 or more";
            throw InputError(text.str());
        }
    added_terms_.push_back(std::move(term));
    sum_stiffness();
    ++version_;
}

bool Boundary::remove_force_term(const ForceTerm* term) {
    if (std::erase_if(added_terms_, [&](const auto& t) { return t.get() == term; }) == 0)
        return false;
    sum_stiffness();
    ++version_;
    return true;
}

void Boundary::update() {
    loads_.update(view());
    for (const auto& term : added_terms_) term->update(view());
}

void Boundary::outer_forces_at(std::span<const Vec3> positions, double time, const Workers& workers,
                               std::span<Vec3> forces) const {
    workers.for_each_range(structure_.masses().size(),
                           [&](NodeRange range) { set_forces(range, positions, time, forces); });
}

void Boundary::set_forces(NodeRange range, std::span<const Vec3> positions, double time,
                          std::span<Vec3> forces) const {
    for (std::size_t n = range.begin; n < range.end; ++n) forces[n].setZero();
    loads_.add_forces(view(), range, positions, time, forces);
    for (const auto& term : added_terms_) term->add_forces(view(), range, positions, time, forces);
}

void Boundary::visit_tangents(std::span<const Vec3> positions, double time,
                              TangentSink& sink) const {
    loads_.visit_tangents(positions, time, sink);
    for (const auto& term : added_terms_) term->visit_tangents(positions, time, sink);
}

double Boundary::stiffness_bound(NodeId n) const {
    double bound = 0.0;
    for (const auto& term : added_terms_) bound += term->stiffness_bound(n);
    return bound;
}

void Boundary::add_reaction(int constraint, int component, double force, const Vec3& x,
                            std::span<Reaction> reactions) const {
    const auto s = static_cast<std::size_t>(constraint);
    reactions[s].force[component] += force;
    reactions[s].torque += (x - constraints_.point(s)).cross(force * Vec3::Unit(component));
}

void Boundary::apply(const BodyView& body, const BodyEdit& edit) {
    outer_forces_.resize(body.masses.size(), Vec3::Zero());
    constraints_.apply(body, edit);
    loads_.apply(body, edit);
    for (const auto& term : added_terms_) term->apply(body, edit);
}

void Boundary::save(ArchiveWriter& ar) const {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    ar(loads_.gravity(), damping_, copy(constraints_.all()), copy(loads_.all()));
}

void Boundary::restore(ArchiveReader& ar) {
    BoundaryConditions conditions = read_boundary_conditions(structure_.mesh(), ar);
    damping_ = conditions.damping;
    loads_ = Loads(conditions.gravity, std::move(conditions.loads), view());
    constraints_ = Constraints(view(), std::move(conditions.constraints));
    clear_reactions();
}

void Boundary::restore_reactions(ArchiveReader& ar) {
    auto reactions = ar.read<std::vector<Reaction>>();
    if (reactions.size() != reactions_.size())
        throw InputError("the reactions are those of another body");
    reactions_ = std::move(reactions);
}

}  // namespace incise::physics
