// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/state.h"

#include <algorithm>
#include <cmath>

#include "incise/base/error.h"

namespace incise::physics {

using fragments::FragmentMeshChanges;
using fragments::NodeRecord;

State::State(const fragments::FragmentMesh& fragments, std::size_t history_size)
    : positions_(fragments.rest_positions().begin(), fragments.rest_positions().end()),
      velocities_(positions_.size(), Vec3::Zero()),
      history_(history_size, fragments.element_capacity()) {}

// A merge keeps momentum and centre of mass. If both states are equal, they stay so bit for bit.
void State::merge(NodeId absorbed, NodeId survivor, double weight) {
    const std::size_t from = absorbed.index(), into = survivor.index();
    Merge merge{survivor, positions_[into], velocities_[into], {}, {}};
    positions_[into] += weight * (positions_[from] - positions_[into]);
    velocities_[into] += weight * (velocities_[from] - velocities_[into]);
    ++version_;
    merge.position_after = positions_[into];
    merge.velocity_after = velocities_[into];
    merges_[absorbed] = merge;
}

void State::merge_all(std::span<const NodeRecord> removed, std::span<const double> masses) {
    std::map<NodeId, double> grown;  // the masses of nodes that others were merged into, kg
    const auto mass_of = [&](NodeId n) {
        if (const auto found = grown.find(n); found != grown.end()) return found->second;
        return n.index() < masses.size() ? masses[n.index()] : 0.0;
    };
    for (const NodeRecord& record : removed) {
        if (record.num_sources != 1) continue;
        const NodeId survivor = record.sources[0].node;
        const double mass = mass_of(record.id);
        if (mass == 0.0) continue;  // the node was added by the same edit and has no state
        const double sum = mass + mass_of(survivor);
        merge(record.id, survivor, mass / sum);
        grown[survivor] = sum;
    }
}

// The absorbed node still has its state in the arrays. The state of the survivor is restored,
// unless the survivor has moved since the merge.
bool State::take_back_merge(NodeId absorbed) {
    const auto found = merges_.find(absorbed);
    if (found == merges_.end()) return false;
    const Merge merge = found->second;
    merges_.erase(found);
    const std::size_t n = merge.survivor.index();
    if (positions_[n] != merge.position_after || velocities_[n] != merge.velocity_after)
        return false;
    positions_[n] = merge.position_before;
    velocities_[n] = merge.velocity_before;
    ++version_;
    return true;
}

void State::take_from_sources(const NodeRecord& record) {
    if (record.num_sources == 0) return;  // an undo brings it back, with its state
    Vec3 x = Vec3::Zero(), v = Vec3::Zero();
    for (int s = 0; s < record.num_sources; ++s) {
        const auto& source = record.sources[static_cast<std::size_t>(s)];
        x += source.weight * positions_[source.node.index()];
        v += source.weight * velocities_[source.node.index()];
    }
    positions_[record.id.index()] = x;
    velocities_[record.id.index()] = v;
}

void State::apply(const fragments::FragmentMesh& fragments, const FragmentMeshChanges& changes,
                  std::span<const double> masses) {
    const std::size_t most_nodes =
        std::max(changes.node_capacity_before, changes.node_capacity_after);
    positions_.resize(most_nodes, Vec3::Zero());
    velocities_.resize(most_nodes, Vec3::Zero());
    merge_all(changes.nodes_removed, masses);
    const auto& added = changes.nodes_added;
    const auto first_born =
        std::lower_bound(added.begin(), added.end(), NodeId(changes.node_capacity_before),
                         [](const NodeRecord& record, NodeId n) { return record.id < n; });
    // Nodes that an undo brings back, in descending order: of several nodes that were merged into
    // one survivor, the last one leaves it first.
    for (auto record = std::make_reverse_iterator(first_born); record != added.rend(); ++record)
        if (!take_back_merge(record->id)) take_from_sources(*record);
    // New nodes, in ascending order: a node may lie between others that the same edit has added.
    std::for_each(first_born, added.end(), [&](const NodeRecord& r) { take_from_sources(r); });
    merges_.erase(merges_.lower_bound(NodeId(changes.node_capacity_after)), merges_.end());
    positions_.resize(changes.node_capacity_after);
    velocities_.resize(changes.node_capacity_after);
    history_.apply(fragments, changes);
}

void State::save(ArchiveWriter& ar) const {
    ar(positions_, velocities_, std::vector(history_.values().begin(), history_.values().end()),
       merges_, largest_move_);
}

void State::restore(ArchiveReader& ar) {
    std::vector<Vec3> positions, velocities;
    std::vector<double> history;
    std::map<NodeId, Merge> merges;
    double largest_move = 0.0;
    ar(positions, velocities, history, merges, largest_move);
    const auto is_there = [&](NodeId n) { return n.is_valid() && n.index() < positions_.size(); };
    if (positions.size() != positions_.size() || velocities.size() != velocities_.size() ||
        history.size() != history_.values().size() ||
        !std::ranges::all_of(merges, [&](const auto& row) {
            return is_there(row.first) && is_there(row.second.survivor);
        }))
        throw InputError("the state is that of another body");
    const auto is_finite = [](const Vec3& v) { return v.allFinite(); };
    if (!std::ranges::all_of(positions, is_finite) || !std::ranges::all_of(velocities, is_finite) ||
        !std::ranges::all_of(history, [](double x) { return std::isfinite(x); }))
        throw InputError("the state is not finite");
    positions_ = std::move(positions);
    velocities_ = std::move(velocities);
    history_.set_values(history);
    merges_ = std::move(merges);
    largest_move_ = largest_move;
    ++version_;
}

}  // namespace incise::physics
