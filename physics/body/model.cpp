// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/model.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"
#include "incise/physics/body/motion_failure.h"

namespace incise::physics {

using topology::ChangeSet;
using topology::NodeRecord;

static_assert(topology::Follower<Model>);

namespace {

double diagonal(const topology::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const NodeId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    return box.diagonal().norm();
}

/// Reads the fibres into the table. Throws InputError if their number does not suit the mesh.
MaterialTable read_fibres(MaterialTable table, const topology::Mesh& mesh, ArchiveReader& ar) {
    const bool has_fibres = std::ranges::any_of(table.materials, &Material::has_fibres);
    ar(table.fibres);
    if (table.fibres.size() != (has_fibres ? mesh.element_capacity() : 0))
        throw InputError("the fibres are those of another body");
    return table;
}

BoundaryConditions read_boundary_conditions(const topology::Mesh& mesh, ArchiveReader& ar) {
    BoundaryConditions boundary_conditions;
    ar(boundary_conditions.gravity, boundary_conditions.damping, boundary_conditions.constraints,
       boundary_conditions.loads);
    for (const Constraint& constraint : boundary_conditions.constraints)
        constraint.require_fit(mesh);
    for (const Load& load : boundary_conditions.loads) load.require_fit(mesh);
    return boundary_conditions;
}

}  // namespace

Model::Model(const topology::Mesh& mesh, const MaterialTable& table,
             BoundaryConditions boundary_conditions)
    : mesh_(mesh),
      epoch_(mesh),
      elements_(mesh, table),
      state_(mesh, elements_.history_size()),
      damping_(boundary_conditions.damping),
      body_size_(diagonal(mesh)),
      masses_(mesh.node_capacity(), 0.0),
      constraints_(mesh, std::move(boundary_conditions.constraints)),
      loads_(boundary_conditions.gravity, {}, view()),
      reactions_(constraints_.size()) {
    resize(mesh.node_capacity());
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) gather(NodeId(n));
    loads_ = Loads(boundary_conditions.gravity, std::move(boundary_conditions.loads), view());
    compute_forces(0.0);
}

void Model::resize(std::size_t num_nodes) {
    elastic_forces_.resize(num_nodes, Vec3::Zero());
    outer_forces_.resize(num_nodes, Vec3::Zero());
    masses_.resize(num_nodes, 0.0);
    node_sums_.resize(num_nodes);
    stable_step_.truncate(num_nodes);
}

// Mass and stiffness of a node are summed over its star in ascending order of elements. This is the
// order of a new model, so that the result is the same bit for bit.
void Model::gather(NodeId n) {
    double mass = 0.0, stiffness = 0.0;
    mesh_.star(n, star_);
    for (const ElementId e : star_) {
        const NodalContributions& shares = elements_.block_of(mesh_, e).contributions(e);
        mass += shares.mass;
        stiffness += shares.stiffness[static_cast<std::size_t>(mesh_.corner_of(e, n))];
    }
    for (const auto& term : added_terms_) stiffness += term->stiffness_bound(n);
    masses_[n.index()] = mass;
    node_sums_.forget(n.index());
    stable_step_.set(n.index(), stiffness, mass);
}

void Model::set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                      double time) {
    const State::Values values = state_.change();
    std::copy(positions.begin(), positions.end(), values.positions.begin());
    std::copy(velocities.begin(), velocities.end(), values.velocities.begin());
    if (!history().is_empty())
        elements_.advance(values.positions, values.positions, 0.0, workers_, values.history);
    compute_forces(time);
}

void Model::compute_forces(double time) {
    update_outer_terms();
    elements_.compute_forces(state_, workers_);
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        elements_.gather_forces(range, elastic_forces_);
        set_outer_forces(range, positions(), time, outer_forces_);
    });
}

void Model::compute_totals_and_forces() { elements_.compute_totals_and_forces(state_, workers_); }

void Model::update_outer_terms() {
    loads_.update(view());
    for (const auto& term : added_terms_) term->update(view());
}

void Model::outer_forces_at(std::span<const Vec3> positions, double time,
                            std::span<Vec3> forces) const {
    workers_.for_each_range(
        masses_.size(), [&](NodeRange range) { set_outer_forces(range, positions, time, forces); });
}

void Model::set_outer_forces(NodeRange range, std::span<const Vec3> positions, double time,
                             std::span<Vec3> forces) const {
    for (std::size_t n = range.begin; n < range.end; ++n) forces[n].setZero();
    loads_.add_forces(view(), range, positions, time, forces);
    for (const auto& term : added_terms_) term->add_forces(view(), range, positions, time, forces);
}

void Model::visit_outer_tangents(std::span<const Vec3> positions, double time,
                                 TangentSink& sink) const {
    loads_.visit_tangents(positions, time, sink);
    for (const auto& term : added_terms_) term->visit_tangents(positions, time, sink);
}

void Model::edit_elements(const ChangeSet& changes) {
    elements_.apply(mesh_, changes);
    for (const auto& record : changes.elements_removed) elements_.erase(record.id, record.region);
    for (const auto& record : changes.elements_added) elements_.insert(mesh_, record.id);
    for (std::size_t i = 0; i < changes.rewired.size(); ++i) {
        const ElementId element = changes.rewired[i].element;
        if (i == 0 || changes.rewired[i - 1].element != element) elements_.replace(mesh_, element);
    }
}

/// Returns the nodes whose mass or stiffness may have changed, in ascending order.
std::vector<NodeId> Model::touched_nodes(const ChangeSet& changes) const {
    std::vector<NodeId> touched;
    const auto touch = [&](std::span<const NodeId> nodes) {
        touched.insert(touched.end(), nodes.begin(), nodes.end());
    };
    const auto touch_all_of = [&](const topology::ElementRecord& record) {
        touch(record.corners);
        // A division, or the undo of one, also changes the shape and mass of the parent.
        const ElementId parent = record.parent;
        if (parent.is_valid() && parent.index() < changes.element_capacity_after)
            touch(mesh_.corners(parent));
    };
    for (const auto& record : changes.elements_removed) touch_all_of(record);
    for (const auto& record : changes.elements_added) touch_all_of(record);
    for (const auto& rewiring : changes.rewired) {
        touched.push_back(rewiring.from);
        touched.push_back(rewiring.to);
    }
    for (const NodeRecord& record : changes.nodes_removed) {
        touched.push_back(record.id);
        // State::apply has added the mass of a merged node to that of its survivor. The mass of the
        // survivor must be summed again, even if its elements have been separated from it since.
        if (record.num_sources == 1) touched.push_back(record.sources[0].node);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    touched.erase(
        std::lower_bound(touched.begin(), touched.end(), NodeId(changes.node_capacity_after)),
        touched.end());
    return touched;
}

void Model::apply(const topology::Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return;
    epoch_.advance(mesh, changes, "model");
    ++structure_version_;
    resize(std::max(changes.node_capacity_before, changes.node_capacity_after));
    state_.apply(mesh, changes, masses_);
    edit_elements(changes);
    resize(changes.node_capacity_after);
    elements_.number_nodes(masses_.size());
    const std::vector<NodeId> touched = touched_nodes(changes);
    for (const NodeId n : touched) gather(n);
    constraints_.apply(mesh_, changes);
    loads_.apply(view(), changes, touched);
    for (const auto& term : added_terms_) term->apply(view(), changes, touched);
}

void Model::add_constraint(Constraint constraint) {
    constraints_.add(mesh_, std::move(constraint));
    reactions_.emplace_back();
    ++structure_version_;
}

void Model::remove_constraint(std::size_t i) {
    constraints_.remove(mesh_, i);
    reactions_.erase(reactions_.begin() + static_cast<std::ptrdiff_t>(i));
    ++structure_version_;
}

void Model::add_load(Load load) {
    loads_.add(std::move(load), view());
    ++structure_version_;
}

void Model::remove_load(std::size_t i) {
    loads_.remove(i);
    ++structure_version_;
}

void Model::add_force_term(std::unique_ptr<ForceTerm> term) {
    term->update(view());
    for (const NodeId n : mesh_.nodes())
        if (const double bound = term->stiffness_bound(n); !(bound >= 0.0 && std::isfinite(bound)))
            throw InputError("a force term bounds its stiffness at node " +
                             std::to_string(mesh_.label(n)) + " by " + std::to_string(bound) +
                             " N/m: it must be finite, and 0 or more");
    added_terms_.push_back(std::move(term));
    for (const NodeId n : mesh_.nodes()) gather(n);
    ++structure_version_;
}

bool Model::remove_force_term(const ForceTerm* term) {
    if (std::erase_if(added_terms_, [&](const auto& t) { return t.get() == term; }) == 0)
        return false;
    for (const NodeId n : mesh_.nodes()) gather(n);
    ++structure_version_;
    return true;
}

void Model::take_force_terms(Model& former, double time) {
    if (former.added_terms_.empty()) return;
    added_terms_.swap(former.added_terms_);
    try {
        update_outer_terms();
        for (const NodeId n : mesh_.nodes()) gather(n);
        compute_forces(time);
    } catch (...) {  // what a term throws
        added_terms_.swap(former.added_terms_);
        throw;
    }
}

void Model::save(ArchiveWriter& ar) const {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    ar(copy(fibres()), loads_.gravity(), damping_, copy(constraints_.all()), copy(loads_.all()));
    state_.save(ar);
    ar(reactions_, external_work_, dissipated_energy_, largest_move_, body_size_,
       structure_version_);
}

Model::Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time)
    // Braces guarantee that the arguments read the archive from left to right.
    : Model{mesh, read_fibres(std::move(table), mesh, ar), read_boundary_conditions(mesh, ar)} {
    restore_state(ar, time);
}

void Model::restore_state(ArchiveReader& ar, double time) {
    state_.restore(ar);
    std::vector<Reaction> reactions;
    ar(reactions, external_work_, dissipated_energy_, largest_move_, body_size_,
       structure_version_);
    if (reactions.size() != reactions_.size())
        throw InputError("the reactions are those of another body");
    reactions_ = std::move(reactions);
    compute_forces(time);
}

double Model::element_stable_step(ElementId e) const {
    const NodalContributions& shares = elements_.block_of(mesh_, e).contributions(e);
    const double stiffness = *std::max_element(shares.stiffness.begin(), shares.stiffness.end());
    return 2.0 / std::sqrt(stiffness / shares.mass);
}

}  // namespace incise::physics
