// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "incise/base/error.h"
#include "incise/fragments/fragment_archive.h"
#include "incise/physics/body/motion_failure.h"

namespace incise::physics {

using fragments::FragmentMesh;

namespace {

double diagonal(const topology::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const VertexId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    return box.diagonal().norm();
}

/// Reads the fibres into the table.
MaterialTable read_fibres(MaterialTable table, ArchiveReader& ar) {
    ar(table.fibres);
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

/// Returns the nodes of all constraints but grasps, which come and go.
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

}  // namespace

Model::Model(const topology::Mesh& mesh, const MaterialTable& table,
             const BoundaryConditions& boundary_conditions)
    : Model(mesh, Parts(mesh, table, boundary_conditions.constraints), boundary_conditions) {}

Model::Model(const topology::Mesh& mesh, Parts parts, BoundaryConditions boundary_conditions)
    : Model(mesh, std::move(parts.fragments), parts.table, std::move(boundary_conditions)) {}

Model::Parts::Parts(const topology::Mesh& mesh, const MaterialTable& of_mesh,
                    std::span<const Constraint> constraints)
    : fragments(mesh, fragments::default_light_share, constrained_by(mesh, constraints)),
      table(of_mesh) {
    if (table.fibres.empty()) return;
    table.fibres.resize(fragments.element_capacity(), Vec3::Zero());
    for (const ElementId e : fragments.elements())
        for (const CellId cell : fragments.cells_of(e))
            if (fragments.is_at_home(cell)) {
                table.fibres[e.index()] = of_mesh.fibres[cell.index()];
                break;
            }
}

Model::Model(const topology::Mesh& mesh, FragmentMesh fragments, const MaterialTable& table,
             BoundaryConditions boundary_conditions)
    : mesh_(mesh),
      fragments_(std::move(fragments)),
      elements_(fragments_, mesh, table),
      state_(fragments_, elements_.history_size()),
      embedding_(mesh, fragments_),
      damping_(boundary_conditions.damping),
      body_size_(diagonal(mesh)),
      masses_(fragments_.node_capacity(), 0.0),
      constraints_(view(), std::move(boundary_conditions.constraints)),
      loads_(boundary_conditions.gravity, {}, view()),
      reactions_(constraints_.size()) {
    constrain_fragments();
    resize(fragments_.node_capacity());
    for (std::size_t n = 0; n < fragments_.node_capacity(); ++n) gather(NodeId(n));
    loads_ = Loads(boundary_conditions.gravity, std::move(boundary_conditions.loads), view());
    compute_forces(0.0);
}

void Model::constrain_fragments() {
    fragments_.constrain(constrained_by(mesh_, constraints_.all()));
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
    fragments_.star(n, star_);
    for (const ElementId e : star_) {
        const NodalContributions& of_element = elements_.block_of(fragments_, e).contributions(e);
        mass += of_element.mass;
        stiffness += of_element.stiffness[static_cast<std::size_t>(fragments_.corner_of(e, n))];
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

void Model::take_force_terms(Model& former, double time) {
    if (former.added_terms_.empty()) return;
    added_terms_.swap(former.added_terms_);
    try {
        update_outer_terms();
        for (const NodeId n : fragments_.nodes()) gather(n);
        compute_forces(time);
    } catch (...) {  // what a term throws
        added_terms_.swap(former.added_terms_);
        throw;
    }
}

void Model::save(ArchiveWriter& ar) const {
    fragments::save(fragments_, ar);
    ar(std::vector(fibres().begin(), fibres().end()));
    save_state(ar);
}

void Model::save_motion(ArchiveWriter& ar) const {
    ar(std::vector(fragments_.constrained().begin(), fragments_.constrained().end()));
    save_state(ar);
}

void Model::save_state(ArchiveWriter& ar) const {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    ar(loads_.gravity(), damping_, copy(constraints_.all()), copy(loads_.all()));
    state_.save(ar);
    ar(reactions_, external_work_, dissipated_energy_, largest_move_, body_size_,
       structure_version_);
}

Model::Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time)
    // Braces guarantee that the arguments read the archive from left to right.
    : Model{mesh, fragments::load_fragments(mesh, ar), read_fibres(std::move(table), ar),
            read_boundary_conditions(mesh, ar)} {
    const bool has_fibres =
        std::ranges::any_of(elements_.materials().materials, &Material::has_fibres);
    if (has_fibres == fibres().empty()) throw InputError("the fibres are those of another body");
    restore_state(ar, time);
}

void Model::restore_motion(ArchiveReader& ar, double time) {
    auto held = ar.read<std::vector<std::uint8_t>>();
    if (held.size() != mesh_.node_capacity())
        throw InputError("the motion is that of another body");
    fragments_.set_constrained(std::move(held));
    BoundaryConditions boundary_conditions = read_boundary_conditions(mesh_, ar);
    damping_ = boundary_conditions.damping;
    loads_ = Loads(boundary_conditions.gravity, std::move(boundary_conditions.loads), view());
    constraints_ = Constraints(view(), std::move(boundary_conditions.constraints));
    reactions_.assign(constraints_.size(), {});
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

double Model::stable_step() const {
    double highest = stable_step_.highest();
    if (!elements_.compute_excess_stiffness(state_, workers_)) return StableStep::step_of(highest);
    std::vector<double>& of_ranges = highest_of_ranges_;
    of_ranges.assign(num_node_ranges(masses_.size()), 0.0);
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        std::array<double, nodes_per_range> excess{};
        elements_.gather_excess_stiffness(range, excess);
        for (std::size_t n = range.begin; n < range.end; ++n)
            if (const double more = excess[n - range.begin]; more > 0.0)
                of_ranges[range.number] =
                    std::max(of_ranges[range.number], stable_step_.quotient(n) + more / masses_[n]);
    });
    for (const double of_range : of_ranges) highest = std::max(highest, of_range);
    return StableStep::step_of(highest);
}

double Model::stable_step(std::span<const NodeId> nodes) const {
    std::map<ElementId, double> factors;
    std::vector<ElementId> star;
    double highest = 0.0;
    for (const NodeId n : nodes) {
        if (n.index() >= masses_.size() || masses_[n.index()] == 0.0) continue;
        double excess = 0.0;
        fragments_.star(n, star);
        for (const ElementId e : star) {
            const ElementBlock& block = elements_.block_of(fragments_, e);
            const auto [it, is_new] = factors.try_emplace(e, 1.0);
            if (is_new) it->second = block.stiffening(e, positions());
            excess += (it->second - 1.0) *
                      block.contributions(e)
                          .stiffness[static_cast<std::size_t>(fragments_.corner_of(e, n))];
        }
        highest = std::max(highest, stable_step_.quotient(n.index()) + excess / masses_[n.index()]);
    }
    return StableStep::step_of(highest);
}

double Model::element_stable_step(ElementId e) const {
    const NodalContributions& of_element = elements_.block_of(fragments_, e).contributions(e);
    const double stiffness =
        *std::max_element(of_element.stiffness.begin(), of_element.stiffness.end());
    return 2.0 / std::sqrt(stiffness / of_element.mass);
}

std::vector<double> Model::mesh_masses() const {
    std::vector<double> masses(mesh_.node_capacity(), 0.0);
    for (const CellId e : mesh_.elements()) {
        const double mass = view().mass_at_corners(e);
        for (const VertexId n : mesh_.corners(e)) masses[n.index()] += mass;
    }
    return masses;
}

std::vector<Vec3> Model::mesh_elastic_forces() const {
    const std::vector<double> masses = mesh_masses();
    std::vector<Vec3> forces(masses.size(), Vec3::Zero());
    for (const VertexId n : mesh_.nodes()) {
        embedding_[n].for_each([&](NodeId node, double weight) {
            forces[n.index()] +=
                masses[n.index()] * weight / masses_[node.index()] * elastic_forces_[node.index()];
        });
    }
    return forces;
}

}  // namespace incise::physics
