// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/supports.h"

#include <Eigen/Geometry>

#include "topology/error.h"

namespace incise::physics {

using topology::NodeId;

Vec3 Support::target(const Vec3& X, double time) const {
    Vec3 x = X;
    if (!angle.is_empty()) x = point + Eigen::AngleAxisd(angle.at(time), axis) * (X - point);
    if (!displacement.is_empty()) x += displacement.at(time);
    return x;
}

Supports::Supports(const topology::Mesh& mesh, std::vector<Support> supports)
    : supports_(std::move(supports)) {
    index_nodes(mesh);
}

void Supports::index_nodes(const topology::Mesh& mesh) {
    row_of_node_.assign(mesh.node_capacity(), -1);
    rows_.clear();
    for (std::size_t s = 0; s < supports_.size(); ++s)
        for (const NodeSet::Member& member : supports_[s].nodes.members()) {
            const std::size_t n = member.node.index();
            if (!mesh.is_alive(member.node)) continue;
            if (row_of_node_[n] < 0) {
                row_of_node_[n] = static_cast<std::int32_t>(rows_.size());
                rows_.push_back({-1, -1, -1});
            }
            auto& row = rows_[static_cast<std::size_t>(row_of_node_[n])];
            for (std::size_t c = 0; c < 3; ++c) {
                if (!supports_[s].components[c]) continue;
                if (row[c] >= 0)
                    throw InputError("node " + std::to_string(mesh.label(member.node)) +
                                     " is held in " + "xyz"[c] + " by both '" +
                                     supports_[static_cast<std::size_t>(row[c])].name + "' and '" +
                                     supports_[s].name + "'; make their selections disjoint");
                row[c] = static_cast<int>(s);
            }
        }
}

void Supports::place(const std::array<int, 3>& support_of, const Vec3& X, double time,
                     Vec3& x) const {
    for (int c = 0; c < 3; ++c) {
        const int s = support_of[static_cast<std::size_t>(c)];
        if (s >= 0) x[c] = supports_[static_cast<std::size_t>(s)].target(X, time)[c];
    }
}

void Supports::apply(const topology::Mesh& mesh, const topology::ChangeSet& changes) {
    bool any = false;
    for (Support& support : supports_) any = support.nodes.apply(changes) || any;
    if (any) index_nodes(mesh);
}

}  // namespace incise::physics
