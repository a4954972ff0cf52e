// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/supports.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "incise/base/error.h"

namespace incise::physics {

Vec3 Support::target(const topology::Mesh& mesh, NodeId n, double time) const {
    if (!grip.is_empty()) return grip.at(time).to_world(gripped.at(n));
    const Vec3& X = mesh.rest_position(n);
    Vec3 x = X;
    if (!angle.is_empty()) x = point + Eigen::AngleAxisd(angle.at(time), axis) * (X - point);
    if (!displacement.is_empty()) x += displacement.at(time);
    return x;
}

void Support::apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
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

void Support::require_fit(const topology::Mesh& mesh) const {
    nodes.require_fit(mesh);
    if (grip.is_empty()) return;
    for (const auto& [time, pose] : grip.keys())
        if (!pose.is_sound()) throw InputError("the pose of a grip is none");
    for (const NodeSet::Member& member : nodes.members())
        if (!gripped.contains(member.node)) throw InputError("a grip misses one of its nodes");
}

Support make_grip(std::string name, std::vector<NodeId> nodes, std::span<const Vec3> positions,
                  const Pose& pose) {
    Support support;
    support.name = std::move(name);
    for (const NodeId n : nodes) support.gripped[n] = pose.to_tool(positions[n.index()]);
    support.nodes = NodeSet(std::move(nodes));
    support.grip = TimeCurve<Pose>({{0.0, pose}});
    return support;
}

std::vector<SupportConflict> find_conflicts(const topology::Mesh& mesh,
                                            std::span<const Support> supports) {
    constexpr auto nobody = static_cast<std::size_t>(-1);
    constexpr std::array<std::size_t, 3> free{nobody, nobody, nobody};
    std::vector<std::array<std::size_t, 3>> first_of(mesh.node_capacity(), free);
    std::vector<std::size_t> last_second(supports.size(), nobody);  // found with each first one
    std::vector<SupportConflict> conflicts;
    for (std::size_t s = 0; s < supports.size(); ++s)
        for (const NodeSet::Member& member : supports[s].nodes.members())
            for (std::size_t c = 0; c < 3 && mesh.is_alive(member.node); ++c) {
                if (!supports[s].components[c]) continue;
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

std::string describe(const SupportConflict& conflict, const topology::Mesh& mesh,
                     std::span<const Support> supports) {
    return "node " + std::to_string(mesh.label(conflict.node)) + " is held in " +
           "xyz"[conflict.component] + " by both '" + supports[conflict.first].name + "' and '" +
           supports[conflict.second].name + "'; make their selections disjoint";
}

Supports::Supports(const topology::Mesh& mesh, std::vector<Support> supports)
    : supports_(std::move(supports)) {
    index_all(mesh);
}

void Supports::index_all(const topology::Mesh& mesh) {
    rows_.clear();
    row_of_node_.assign(mesh.node_capacity(), -1);
    for (const Support& support : supports_)
        for (const NodeSet::Member& member : support.nodes.members()) index(mesh, member.node);
}

void Supports::add(const topology::Mesh& mesh, Support support) {
    supports_.push_back(std::move(support));
    try {
        index_all(mesh);
    } catch (const InputError&) {
        supports_.pop_back();
        index_all(mesh);
        throw;
    }
}

void Supports::remove(const topology::Mesh& mesh, std::size_t i) {
    supports_.erase(supports_.begin() + static_cast<std::ptrdiff_t>(i));
    index_all(mesh);
}

void Supports::index(const topology::Mesh& mesh, NodeId n) {
    constexpr std::array<int, 3> free{-1, -1, -1};
    std::array<int, 3> row = free;
    for (std::size_t s = 0; s < supports_.size() && mesh.is_alive(n); ++s) {
        if (!supports_[s].nodes.contains(n)) continue;
        for (std::size_t c = 0; c < 3; ++c) {
            if (!supports_[s].components[c]) continue;
            if (row[c] >= 0)
                throw InputError(
                    describe({n, c, static_cast<std::size_t>(row[c]), s}, mesh, supports_));
            row[c] = static_cast<int>(s);
        }
    }
    row_of_node_[n.index()] = -1;
    if (row == free) return;
    const auto place = std::find(rows_.begin(), rows_.end(), row);
    row_of_node_[n.index()] = static_cast<std::int32_t>(place - rows_.begin());
    if (place == rows_.end()) rows_.push_back(row);
}

void Supports::place(const std::array<int, 3>& support_of, const topology::Mesh& mesh, NodeId n,
                     double time, Vec3& x) const {
    int last = -1;
    Vec3 target = Vec3::Zero();
    for (int c = 0; c < 3; ++c) {
        const int s = support_of[static_cast<std::size_t>(c)];
        if (s < 0) continue;
        if (s != last) target = supports_[static_cast<std::size_t>(s)].target(mesh, n, time);
        last = s;
        x[c] = target[c];
    }
}

void Supports::apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    for (Support& support : supports_) support.apply(mesh, changes);
    row_of_node_.resize(changes.node_capacity_after, -1);
    for (const auto* records : {&changes.nodes_added, &changes.nodes_removed})
        for (const topology::NodeRecord& record : *records)
            if (record.id.index() < changes.node_capacity_after) index(mesh, record.id);
}

}  // namespace incise::physics
