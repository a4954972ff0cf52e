// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/near_nodes.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

bool NearNodes::has(const EdgeEnd& end, const Vec3& normal_at_rest) {
    const Vec3 x = mesh_.rest_position(end.node), edge = mesh_.rest_position(end.other) - x;
    const double distance = end.from * edge.norm();
    if (distance >= limits_.farthest) return false;
    if (end.place < 0.5 && end.from < limits_.share) return true;
    if (distance >= limits_.share * longest_edge_once(end)) return false;
    const Vec3 towards = std::copysign(1.0, normal_at_rest.dot(edge)) * normal_at_rest;
    const auto is_long = [&](NodeId n) {
        const Vec3 other = mesh_.rest_position(n) - x;
        return towards.dot(other) > 2.0 * distance && distance < limits_.share * other.norm();
    };
    collect_star(end);
    return std::any_of(star_.begin(), star_.end(), [&](ElementId e) {
        const auto corners = mesh_.corners(e);
        return std::any_of(corners.begin(), corners.end(), is_long);
    });
}

void NearNodes::collect_star(const EdgeEnd& end) {
    star_.clear();
    topology::collect_star(mesh_, end.node, end.element, star_);
}

/// Returns the length of the longest edge at the node at the first call for it, m at rest. Its
/// edges are not longer now.
double NearNodes::longest_edge_once(const EdgeEnd& end) {
    const auto [place, is_new] = longest_edges_.try_emplace(end.node, 0.0);
    double& longest = place->second;
    if (!is_new) return longest;
    collect_star(end);
    for (const ElementId e : star_)
        for (const NodeId n : mesh_.corners(e))
            longest =
                std::max(longest, (mesh_.rest_position(n) - mesh_.rest_position(end.node)).norm());
    return longest;
}

}  // namespace incise::cutting
