// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/constraints.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "incise/base/error.h"

namespace incise::physics {

Vec3 Constraint::target(const topology::Mesh& mesh, NodeId n, double time) const {
    if (!grip.is_empty()) return grip.at(time).to_world(gripped.at(n));
    const Vec3& X = mesh.rest_position(n);
    Vec3 x = X;
    if (!angle.is_empty()) x = point + Eigen::AngleAxisd(angle.at(time), axis) * (X - point);
    if (!displacement.is_empty()) x += displacement.at(time);
    return x;
}

void Constraint::apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    nodes.apply(mesh, changes);
    if (grip.is_empty()) return;
    gripped.erase(gripped.lower_bound(NodeId(changes.node_capacity_after)), gripped.end());
    for (const topology::NodeRecord& record : changes.nodes_added) {
        if (gripped.contains(record.id) || !nodes.contains(record.id)) continue;
        Vec3 local = Vec3::Zero();
        for (int s = 0; s < record.num_sources; ++s) {
            const auto& source = record.sources[static_cast<std::size_t>(s)];
            local += source.weight * gripped.at(source.node);
        }
        gripped[record.id] = local;
    }
}

void Constraint::require_fit(const topology::Mesh& mesh) const {
    nodes.require_fit(mesh);
    if (grip.is_empty()) return;
    for (const auto& [time, pose] : grip.keys())
        if (!pose.is_sound()) throw InputError("the pose of a grip is none");
    for (const NodeSet::Member& member : nodes.members())
        if (!gripped.contains(member.node)) throw InputError("a grip misses one of its nodes");
}

Constraint make_grip(std::string name, std::vector<NodeId> nodes, std::span<const Vec3> positions,
                     const Pose& pose) {
    Constraint constraint;
    constraint.name = std::move(name);
    for (const NodeId n : nodes) constraint.gripped[n] = pose.to_tool(positions[n.index()]);
    constraint.nodes = NodeSet(std::move(nodes));
    constraint.grip = TimeCurve<Pose>({{0.0, pose}});
    return constraint;
}

std::vector<ConstraintConflict> find_conflicts(const topology::Mesh& mesh,
                                               std::span<const Constraint> constraints) {
    constexpr auto nobody = static_cast<std::size_t>(-1);
    constexpr std::array<std::size_t, 3> free{nobody, nobody, nobody};
    std::vector<std::array<std::size_t, 3>> first_of(mesh.node_capacity(), free);
    std::vector<std::size_t> last_second(constraints.size(), nobody);  // found with each first one
    std::vector<ConstraintConflict> conflicts;
    for (std::size_t s = 0; s < constraints.size(); ++s)
        for (const NodeSet::Member& member : constraints[s].nodes.members())
            for (std::size_t c = 0; c < 3 && mesh.is_alive(member.node); ++c) {
                if (!constraints[s].components[c]) continue;
                std::size_t& first = first_of[member.node.index()][c];
                if (first == nobody) {
                    first = s;
                } else if (last_second[first] != s) {
                    last_second[first] = s;
                    conflicts.push_back({member.node, c, first, s});
                }
            }
    return conflicts;
}

std::string describe(const ConstraintConflict& conflict, const topology::Mesh& mesh,
                     std::span<const Constraint> constraints) {
    return "node " + std::to_string(mesh.label(conflict.node)) + " is held in " +
           "xyz"[conflict.component] + " by both '" + constraints[conflict.first].name + "' and '" +
           constraints[conflict.second].name + "'; make their selections disjoint";
}

Constraints::Constraints(const topology::Mesh& mesh, std::vector<Constraint> constraints)
    : constraints_(std::move(constraints)) {
    index_all(mesh);
}

void Constraints::index_all(const topology::Mesh& mesh) {
    rows_.clear();
    row_of_node_.assign(mesh.node_capacity(), -1);
    for (const Constraint& constraint : constraints_)
        for (const NodeSet::Member& member : constraint.nodes.members()) index(mesh, member.node);
}

void Constraints::add(const topology::Mesh& mesh, Constraint constraint) {
    constraints_.push_back(std::move(constraint));
    try {
        index_all(mesh);
    } catch (const InputError&) {
        constraints_.pop_back();
        index_all(mesh);
        throw;
    }
}

void Constraints::remove(const topology::Mesh& mesh, std::size_t i) {
    constraints_.erase(constraints_.begin() + static_cast<std::ptrdiff_t>(i));
    index_all(mesh);
}

void Constraints::index(const topology::Mesh& mesh, NodeId n) {
    constexpr std::array<int, 3> free{-1, -1, -1};
    std::array<int, 3> row = free;
    const auto refuse = [&](const ConstraintConflict& conflict) {
        throw ConflictingConstraints(describe(conflict, mesh, constraints_), conflict);
    };
    for (std::size_t s = 0; s < constraints_.size() && mesh.is_alive(n); ++s) {
        if (!constraints_[s].nodes.contains(n)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            if (!constraints_[s].components[c]) continue;
            if (row[c] >= 0) refuse({n, c, static_cast<std::size_t>(row[c]), s});
            row[c] = static_cast<int>(s);
        }
    }
    row_of_node_[n.index()] = -1;
    if (row == free) return;
    const auto it = std::find(rows_.begin(), rows_.end(), row);
    row_of_node_[n.index()] = static_cast<std::int32_t>(it - rows_.begin());
    if (it == rows_.end()) rows_.push_back(row);
}

void Constraints::prescribe(const std::array<int, 3>& constraint_of, const topology::Mesh& mesh,
                            NodeId n, double time, Vec3& x) const {
    int last = -1;
    Vec3 target = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
        const int s = constraint_of[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        if (s != last) target = constraints_[static_cast<std::size_t>(s)].target(mesh, n, time);
        last = s;
        x[c] = target[c];
    }
}

void Constraints::apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    for (Constraint& constraint : constraints_) constraint.apply(mesh, changes);
    row_of_node_.resize(changes.node_capacity_after, -1);
    for (const auto* records : {&changes.nodes_added, &changes.nodes_removed})
        for (const topology::NodeRecord& record : *records)
            if (record.id.index() < changes.node_capacity_after) index(mesh, record.id);
}

}  // namespace incise::physics
