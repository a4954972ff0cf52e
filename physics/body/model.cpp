// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/model.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"
#include "incise/physics/body/motion_failure.h"

namespace incise::physics {

using topology::ChangeSet;
using topology::NodeRecord;

namespace {

double diagonal(const topology::Mesh& mesh) {
    Eigen::AlignedBox3d box;
    for (const NodeId n : mesh.nodes()) box.extend(mesh.rest_position(n));
    return box.diagonal().norm();
}

/// Throws InputError, as the next one does.
MaterialTable read_fibres(MaterialTable table, const topology::Mesh& mesh, ArchiveReader& ar) {
    const bool has_fibres = std::ranges::any_of(table.materials, &Material::has_fibres);
    ar(table.fibres);
    if (table.fibres.size() != (has_fibres ? mesh.element_capacity() : 0))
        throw InputError("the fibres are those of another body");
    return table;
}

Surroundings read_surroundings(const topology::Mesh& mesh, ArchiveReader& ar) {
    Surroundings surroundings;
    ar(surroundings.gravity, surroundings.damping, surroundings.supports, surroundings.loads);
    for (const Support& support : surroundings.supports) support.require_fit(mesh);
    for (const Load& load : surroundings.loads) load.require_fit(mesh);
    return surroundings;
}

}  // namespace

Model::Model(const topology::Mesh& mesh, const MaterialTable& table, Surroundings surroundings)
    : mesh_(mesh),
      epoch_(mesh),
      elements_(mesh, table),
      history_(elements_.history_size(), mesh.element_capacity()),
      gravity_(surroundings.gravity),
      damping_(surroundings.damping),
      body_size_(diagonal(mesh)),
      positions_(mesh.rest_positions().begin(), mesh.rest_positions().end()),
      masses_(mesh.node_capacity(), 0.0),
      supports_(mesh, std::move(surroundings.supports)),
      loads_({}, loaded_body()),
      reactions_(supports_.size()) {
    resize(mesh.node_capacity());
    for (std::size_t n = 0; n < mesh.node_capacity(); ++n) gather(NodeId(n));
    loads_ = Loads(std::move(surroundings.loads), loaded_body());
    compute_forces(0.0);
}

void Model::resize(std::size_t num_nodes) {
    positions_.resize(num_nodes, Vec3::Zero());
    velocities_.resize(num_nodes, Vec3::Zero());
    elastic_forces_.resize(num_nodes, Vec3::Zero());
    outer_forces_.resize(num_nodes, Vec3::Zero());
    masses_.resize(num_nodes, 0.0);
    node_sums_.resize(num_nodes);
    stable_step_.truncate(num_nodes);
}

// Mass and stiffness of a node, summed over its star in ascending order of elements: the same
// terms in the same order as in a model built afresh, hence the same bits.
void Model::gather(NodeId n) {
    double mass = 0.0, stiffness = 0.0;
    mesh_.star(n, star_);
    for (const ElementId e : star_) {
        const ElementShares& shares = elements_.block_of(mesh_, e).shares(e);
        mass += shares.mass;
        stiffness += shares.stiffness[static_cast<std::size_t>(mesh_.corner_of(e, n))];
    }
    masses_[n.index()] = mass;
    node_sums_.forget(n.index());
    stable_step_.set(n.index(), stiffness, mass);
}

void Model::state_has_changed() {
    elements_.state_has_changed();
    node_sums_.forget_all();
}

void Model::set_state(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                      double time) {
    std::copy(positions.begin(), positions.end(), positions_.begin());
    std::copy(velocities.begin(), velocities.end(), velocities_.begin());
    state_has_changed();
    if (!history_.is_empty()) elements_.advance(positions_, positions_, 0.0, workers_, history_);
    compute_forces(time);
}

void Model::compute_forces(double time) {
    loads_.update(loaded_body());
    elements_.compute_forces(positions_, history_, workers_);
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        elements_.gather_forces(range, elastic_forces_);
        set_outer_forces(range, positions_, time, outer_forces_);
    });
}

void Model::compute_states_and_forces() {
    elements_.compute_states_and_forces(positions_, history_, workers_);
}

void Model::outer_forces_at(std::span<const Vec3> positions, double time,
                            std::span<Vec3> forces) const {
    workers_.for_each_range(
        masses_.size(), [&](NodeRange range) { set_outer_forces(range, positions, time, forces); });
}

void Model::set_outer_forces(NodeRange range, std::span<const Vec3> positions, double time,
                             std::span<Vec3> forces) const {
    for (std::size_t n = range.begin; n < range.end; ++n) forces[n] = masses_[n] * gravity_;
    loads_.add(range, positions, time, forces);
}

void Model::integrate(double time, double dt) {
    const std::size_t num_ranges = num_node_ranges(masses_.size());
    step_sums_.assign(num_ranges, {});
    range_reactions_.assign(num_ranges * supports_.size(), {});
    if (!history_.is_empty()) previous_positions_.resize(positions_.size());
    workers_.for_each_range(masses_.size(), [&](NodeRange range) {
        const auto reactions =
            std::span(range_reactions_).subspan(range.number * supports_.size(), supports_.size());
        step_sums_[range.number] = move_nodes(range, time, dt, reactions);
    });
    state_has_changed();
    StepSums sums;
    for (const StepSums& range : step_sums_) sums += range;
    reactions_.assign(supports_.size(), {});
    for (std::size_t i = 0; i < range_reactions_.size(); ++i)
        reactions_[i % supports_.size()] += range_reactions_[i];
    external_work_ += sums.work;
    dissipated_energy_ += damping_ * sums.mass_times_square * dt;
    largest_move_ = std::sqrt(sums.largest_square) * dt;
    if (!sums.is_finite() || largest_move_ > body_size_) throw failure_of_step(*this, time, dt);
    if (!history_.is_empty())
        dissipated_energy_ +=
            elements_.advance(previous_positions_, positions_, dt, workers_, history_);
}

StepSums Model::move_nodes(NodeRange range, double time, double dt, std::span<Reaction> reactions) {
    if (!history_.is_empty())
        for (std::size_t n = range.begin; n < range.end; ++n)
            previous_positions_[n] = positions_[n];
    const double slowing = 1.0 / (1.0 + damping_ * dt);
    StepSums sums;
    for (std::size_t n = range.begin; n < range.end;) {
        if (const std::size_t count = num_free_nodes(n, range.end)) {
            sums += move_free_nodes({&masses_[n], &elastic_forces_[n], &outer_forces_[n],
                                     &positions_[n], &velocities_[n]},
                                    count, dt, slowing);
            n += count;
            continue;
        }
        const std::size_t end = std::min(n + nodes_together, range.end);
        for (; n < end; ++n)
            if (masses_[n] != 0.0) sums += move_node(n, time, dt, slowing, reactions);  // else dead
    }
    return sums;
}

std::size_t Model::num_free_nodes(std::size_t n, std::size_t end) const {
    std::size_t count = 0;
    for (std::size_t i = n; i < end && masses_[i] != 0.0 && !supports_.of_node(i); ++i) ++count;
    return count - count % nodes_together;
}

// What has no address, as the node's step has none, stays in registers.
StepSums Model::move_node(std::size_t n, double time, double dt, double slowing,
                          std::span<Reaction> reactions) {
    const double mass = masses_[n];
    const Vec3 x = positions_[n], v = velocities_[n];
    const Vec3 outer = outer_forces_[n], force = elastic_forces_[n] + outer;
    NodeStep step;
    step.v = slowing * (v + dt / mass * force);
    step.x = x + dt * step.v;
    step.work = 0.0;
    if (supports_.of_node(n)) step = support_node(n, time, dt, force, step, reactions);
    positions_[n] = step.x;
    velocities_[n] = step.v;
    const double square = step.v.squaredNorm();
    return {step.work + outer.dot(step.x - x), mass * square, square};
}

Model::NodeStep Model::support_node(std::size_t n, double time, double dt, const Vec3& force,
                                    NodeStep step, std::span<Reaction> reactions) const {
    const auto& support_of = *supports_.of_node(n);
    const double mass = masses_[n];
    const Vec3 &x = positions_[n], &v = velocities_[n];
    supports_.place(support_of, mesh_, NodeId(n), time + dt, step.x);
    for (int c = 0; c < 3; ++c) {
        const int s = support_of[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        step.v[c] = (step.x[c] - x[c]) / dt;
        const double reaction = mass * ((step.v[c] - v[c]) / dt + damping_ * step.v[c]) - force[c];
        add_reaction(s, c, reaction, step.x, reactions);
        // At the mean velocity: a support that sets off at once gives the node just the kinetic
        // energy that it then has.
        step.work +=
            reaction * (step.x[c] - x[c]) - 0.5 * mass * (step.v[c] - v[c]) * (step.v[c] - v[c]);
    }
    return step;
}

void Model::add_reaction(int support, int component, double force, const Vec3& x,
                         std::span<Reaction> reactions) const {
    const auto s = static_cast<std::size_t>(support);
    reactions[s].force[component] += force;
    reactions[s].moment += (x - supports_.point(s)).cross(force * Vec3::Unit(component));
}

void Model::begin_step() {
    loads_.update(loaded_body());
    reactions_.assign(supports_.size(), {});
    largest_move_ = 0.0;
}

double Model::take_step(std::span<const Vec3> positions, std::span<const Vec3> velocities,
                        std::span<const Vec3> reactions, double dt) {
    const double largest_move = largest_move_;
    begin_step();
    double largest_square = 0.0;
    for (std::size_t n = 0; n < masses_.size(); ++n) {
        if (masses_[n] == 0.0) continue;  // dead
        largest_square = std::max(largest_square, (positions[n] - positions_[n]).squaredNorm());
        if (const auto* support_of = supports_.of_node(n))
            for (int c = 0; c < 3; ++c) {
                const int s = (*support_of)[static_cast<std::size_t>(c)];
                if (s < 0) continue;
                add_reaction(s, c, reactions[n][c], positions[n], reactions_);
            }
    }
    largest_move_ = largest_move + std::sqrt(largest_square);
    double taken = 0.0;
    if (!history_.is_empty())
        taken = elements_.advance(positions_, positions, dt, workers_, history_);
    std::copy(positions.begin(), positions.end(), positions_.begin());
    std::copy(velocities.begin(), velocities.end(), velocities_.begin());
    state_has_changed();
    return taken;
}

void Model::book(double external_work, double dissipated_energy) {
    external_work_ += external_work;
    dissipated_energy_ += dissipated_energy;
}

// Keeps momentum and centre of mass; equal states stay what they are to the bit.
void Model::merge(NodeId absorbed, NodeId survivor) {
    const std::size_t from = absorbed.index(), into = survivor.index();
    if (masses_[from] == 0.0) return;  // born in the same edit: nothing to bring
    Merge merge{survivor, positions_[into], velocities_[into], {}, {}};
    const double mass = masses_[from] + masses_[into];
    const double weight = masses_[from] / mass;
    positions_[into] += weight * (positions_[from] - positions_[into]);
    velocities_[into] += weight * (velocities_[from] - velocities_[into]);
    masses_[into] = mass;
    state_has_changed();
    merge.position_after = positions_[into];
    merge.velocity_after = velocities_[into];
    merges_[absorbed] = merge;
}

// The slot of the absorbed node still has its state; the survivor's is given back unless it has
// moved on.
bool Model::take_back_merge(NodeId absorbed) {
    const auto place = merges_.find(absorbed);
    if (place == merges_.end()) return false;
    const Merge merge = place->second;
    merges_.erase(place);
    const std::size_t n = merge.survivor.index();
    if (positions_[n] != merge.position_after || velocities_[n] != merge.velocity_after)
        return false;
    positions_[n] = merge.position_before;
    velocities_[n] = merge.velocity_before;
    state_has_changed();
    return true;
}

void Model::take_from_sources(const NodeRecord& record) {
    if (record.num_sources == 0) return;  // back with what it had
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();
    for (int s = 0; s < record.num_sources; ++s) {
        const auto& source = record.sources[static_cast<std::size_t>(s)];
        x += source.weight * positions_[source.node.index()];
        v += source.weight * velocities_[source.node.index()];
    }
    positions_[record.id.index()] = x;
    velocities_[record.id.index()] = v;
}

void Model::carry_state(const ChangeSet& changes) {
    for (const NodeRecord& record : changes.nodes_removed)
        if (record.num_sources == 1) merge(record.id, record.sources[0].node);
    const auto& added = changes.nodes_added;
    const auto first_born =
        std::lower_bound(added.begin(), added.end(), NodeId(changes.node_capacity_before),
                         [](const NodeRecord& record, NodeId n) { return record.id < n; });
    // In reverse: the last of several nodes to join a survivor leaves it first.
    for (auto record = std::make_reverse_iterator(first_born); record != added.rend(); ++record)
        if (!take_back_merge(record->id)) take_from_sources(*record);
    // In ascending order: a node may lie between others that the edit made before it.
    std::for_each(first_born, added.end(), [&](const NodeRecord& r) { take_from_sources(r); });
    merges_.erase(merges_.lower_bound(NodeId(changes.node_capacity_after)), merges_.end());
}

void Model::apply(const topology::Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return;
    epoch_.advance(mesh, changes, "model");
    ++structure_version_;
    resize(std::max(changes.node_capacity_before, changes.node_capacity_after));
    carry_state(changes);
    history_.apply(mesh, changes);
    elements_.apply(mesh, changes);

    std::vector<NodeId> touched;
    const auto touch = [&](std::span<const NodeId> nodes) {
        touched.insert(touched.end(), nodes.begin(), nodes.end());
    };
    const auto touch_all_of = [&](const topology::ElementRecord& record) {
        touch(record.corners);
        // What it was divided from, or joins again, has another shape and mass now.
        const ElementId parent = record.parent;
        if (parent.is_valid() && parent.index() < changes.element_capacity_after)
            touch(mesh_.corners(parent));
    };
    for (const auto& record : changes.elements_removed) {
        elements_.erase(record.id, record.region);
        touch_all_of(record);
    }
    for (const auto& record : changes.elements_added) {
        elements_.insert(mesh_, record.id);
        touch_all_of(record);
    }
    for (std::size_t i = 0; i < changes.rewired.size(); ++i) {
        const auto& rewiring = changes.rewired[i];
        if (i == 0 || changes.rewired[i - 1].element != rewiring.element)
            elements_.replace(mesh_, rewiring.element);
        touched.push_back(rewiring.from);
        touched.push_back(rewiring.to);
    }
    for (const NodeRecord& record : changes.nodes_removed) {
        touched.push_back(record.id);
        // What it was merged into has its mass, even if the elements have parted from it since.
        if (record.num_sources == 1) touched.push_back(record.sources[0].node);
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    touched.erase(
        std::lower_bound(touched.begin(), touched.end(), NodeId(changes.node_capacity_after)),
        touched.end());
    resize(changes.node_capacity_after);
    elements_.number_nodes(masses_.size());
    for (const NodeId n : touched) gather(n);

    supports_.apply(mesh_, changes);
    loads_.apply(changes, loaded_body(), touched);
}

void Model::add_support(Support support) {
    supports_.add(mesh_, std::move(support));
    reactions_.emplace_back();
    ++structure_version_;
}

void Model::remove_support(std::size_t i) {
    supports_.remove(mesh_, i);
    reactions_.erase(reactions_.begin() + static_cast<std::ptrdiff_t>(i));
    ++structure_version_;
}

void Model::add_load(Load load) {
    loads_.add(std::move(load), loaded_body());
    ++structure_version_;
}

void Model::remove_load(std::size_t i) {
    loads_.remove(i);
    ++structure_version_;
}

void Model::save(ArchiveWriter& ar) const {
    const auto copy = [](const auto& span) { return std::vector(span.begin(), span.end()); };
    ar(copy(fibres()), gravity_, damping_, copy(supports_.all()), copy(loads_.all()));
    ar(positions_, velocities_, copy(history_.values()), reactions_, external_work_,
       dissipated_energy_, largest_move_, body_size_, structure_version_, merges_);
}

Model::Model(const topology::Mesh& mesh, MaterialTable table, ArchiveReader& ar, double time)
    // Braces, as they read the archive from left to right.
    : Model{mesh, read_fibres(std::move(table), mesh, ar), read_surroundings(mesh, ar)} {
    restore_state(ar, time);
}

void Model::restore_state(ArchiveReader& ar, double time) {
    std::vector<Vec3> positions, velocities;
    std::vector<double> history;
    std::vector<Reaction> reactions;
    ar(positions, velocities, history, reactions, external_work_, dissipated_energy_, largest_move_,
       body_size_, structure_version_, merges_);
    const auto is_there = [&](NodeId n) { return n.is_valid() && n.index() < masses_.size(); };
    if (positions.size() != positions_.size() || velocities.size() != velocities_.size() ||
        history.size() != history_.values().size() || reactions.size() != reactions_.size() ||
        !std::ranges::all_of(merges_, [&](const auto& row) {
            return is_there(row.first) && is_there(row.second.survivor);
        }))
        throw InputError("the state is that of another body");
    const auto is_finite = [](const Vec3& v) { return v.allFinite(); };
    if (!std::ranges::all_of(positions, is_finite) || !std::ranges::all_of(velocities, is_finite) ||
        !std::ranges::all_of(history, [](double x) { return std::isfinite(x); }))
        throw InputError("the state is not finite");
    positions_ = std::move(positions);
    velocities_ = std::move(velocities);
    set_history(history);
    reactions_ = std::move(reactions);
    compute_forces(time);
}

double Model::own_step(ElementId e) const {
    const ElementShares& shares = elements_.block_of(mesh_, e).shares(e);
    const double stiffness = *std::max_element(shares.stiffness.begin(), shares.stiffness.end());
    return 2.0 / std::sqrt(stiffness / shares.mass);
}

}  // namespace incise::physics
