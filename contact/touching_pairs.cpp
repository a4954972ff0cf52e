// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/touching_pairs.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace incise::contact {

namespace {

/// Sets the normals of nodes: means of those of the triangles at them, each with its angle there
/// as its weight. They are not of unit length. Other nodes have zero.
void set_node_normals(std::span<const Triangle> triangles, std::span<const Vec3> positions,
                      std::vector<Vec3>& normals) {
    normals.assign(positions.size(), Vec3::Zero());
    for (const Triangle& triangle : triangles) {
        const Vec3 &x = positions[triangle[0].index()], &y = positions[triangle[1].index()],
                   &z = positions[triangle[2].index()];
        const Vec3 area = (y - x).cross(z - x);
        const double double_area = area.norm();
        if (!(double_area > 0.0)) continue;
        const Vec3 normal = area / double_area;
        const auto add = [&](NodeId n, const Vec3& a, const Vec3& b) {
            normals[n.index()] += std::atan2(double_area, a.dot(b)) * normal;
        };
        add(triangle[0], y - x, z - x);
        add(triangle[1], z - y, x - y);
        add(triangle[2], x - z, y - z);
    }
}

/// Tells if a node and a triangle belong to the same part of a body.
class SameParts {
  public:
    SameParts(const SurfaceTree& tree, const ContactBody& body, std::span<const Vec3> rest_normals)
        : tree_(tree), body_(body), rest_normals_(rest_normals) {}

    /// Parts that are farther from each other than the elements round the node have no common
    /// corners. Nearer ones may touch only if they are the two sides of a cut, near its end: then
    /// their normals are against each other, and the node is on the triangle at rest.
    bool operator()(NodeId n, std::size_t t) {
        if (!have_common_corners(n, t)) return false;
        const auto& [a, b, c] = tree_.triangles()[t];
        const auto X = [&](NodeId m) { return body_.mesh.rest_position(m); };
        const Vec3 normal = (X(b) - X(a)).cross(X(c) - X(a)), &of_node = rest_normals_[n.index()];
        constexpr double least_cosine = -0.5;
        if (of_node.dot(normal) > least_cosine * of_node.norm() * normal.norm()) return true;
        constexpr double rounding_of_place = 1e-6;
        const double off = std::sqrt(squared_distance(X(n), X(a), X(b), X(c)));
        return off > rounding_of_place * std::sqrt(normal.norm());
    }

  private:
    bool have_common_corners(NodeId n, std::size_t t) {
        const ElementId fragment = body_.fragments.fragment_of_cell(body_.faces[t].element);
        return std::ranges::any_of(body_.fragments.corners(fragment), [&](NodeId corner) {
            return std::ranges::binary_search(around(n), corner);
        });
    }
    /// Returns the corners of all fragments at a node, in ascending order.
    const std::vector<NodeId>& around(NodeId n) {
        const auto [it, is_new] = around_.try_emplace(n);
        if (!is_new) return it->second;
        std::vector<NodeId>& corners = it->second;
        body_.mesh.star(n, star_);
        for (const ElementId cell : star_) {
            const auto of_fragment =
                body_.fragments.corners(body_.fragments.fragment_of_cell(cell));
            corners.insert(corners.end(), of_fragment.begin(), of_fragment.end());
        }
        std::ranges::sort(corners);
        corners.erase(std::ranges::unique(corners).begin(), corners.end());
        return corners;
    }

    const SurfaceTree& tree_;
    const ContactBody& body_;
    std::span<const Vec3> rest_normals_;  // by node
    std::unordered_map<NodeId, std::vector<NodeId>> around_;
    std::vector<ElementId> star_;
};

}  // namespace

double squared_distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ax = x - a, area = ab.cross(ac);
    const double square = area.squaredNorm();
    if (square > 0.0) {
        const double w2 = ab.cross(ax).dot(area), w1 = ax.cross(ac).dot(area);
        if (w1 >= 0.0 && w2 >= 0.0 && w1 + w2 <= square) {
            const double height = area.dot(ax);
            return height * height / square;
        }
    }
    const auto to_edge = [&](const Vec3& p, const Vec3& q) {
        const Vec3 along = q - p;
        const double length = along.squaredNorm();
        const double at = length > 0.0 ? std::clamp(along.dot(x - p) / length, 0.0, 1.0) : 0.0;
        return (x - p - at * along).squaredNorm();
    };
    return std::min({to_edge(a, b), to_edge(b, c), to_edge(c, a)});
}

void TouchingPairs::set_surface(const SurfaceTree& tree, const ContactBody& body) {
    set_node_normals(tree.triangles(), body.mesh.rest_positions(), rest_normals_);
    surface_nodes_.clear();
    std::vector<bool> is_listed(body.mesh.node_capacity(), false);
    for (const std::uint32_t t : tree.order()) {
        if (body.takes_part[t] == 0) continue;
        for (const NodeId n : tree.triangles()[t]) {
            if (is_listed[n.index()]) continue;
            is_listed[n.index()] = true;
            surface_nodes_.push_back(n);
        }
    }
}

void TouchingPairs::find(const SurfaceTree& tree, const ContactBody& body,
                         std::span<const Vec3> positions, double reach) {
    found_.clear();
    append_pairs(tree, body, positions, reach, surface_nodes_);
    take_found();
}

void TouchingPairs::find_again(const SurfaceTree& tree, const ContactBody& body,
                               std::span<const Vec3> positions, double reach,
                               std::span<const std::int32_t> number_of_old,
                               const std::function<bool(NodeId)>& is_chosen) {
    found_.clear();
    std::vector<NodeId> chosen;
    for (const NodeId n : surface_nodes_) {
        const auto it = std::ranges::lower_bound(nodes_, n);
        const bool is_known = it != nodes_.end() && *it == n;
        const auto old = is_known ? triangles_of(static_cast<std::size_t>(it - nodes_.begin()))
                                  : std::span<const std::uint32_t>();
        const bool is_whole =
            std::ranges::all_of(old, [&](std::uint32_t t) { return number_of_old[t] >= 0; });
        if (is_chosen(n) || !is_whole) {
            chosen.push_back(n);
            continue;
        }
        for (const std::uint32_t t : old)
            found_.emplace_back(n, static_cast<std::uint32_t>(number_of_old[t]));
    }
    append_pairs(tree, body, positions, reach, chosen);
    take_found();
}

// Nodes that follow each other in the order of the tree are near each other: they look for
// triangles in groups.
void TouchingPairs::append_pairs(const SurfaceTree& tree, const ContactBody& body,
                                 std::span<const Vec3> positions, double reach,
                                 std::span<const NodeId> nodes) {
    constexpr std::size_t group_size = 8;
    set_node_normals(tree.triangles(), positions, normals_);
    SameParts are_same_part(tree, body, rest_normals_);
    const auto is_near = [&](NodeId n, std::uint32_t t) {
        const Vec3& x = positions[n.index()];
        const auto& [a, b, c] = tree.triangles()[t];
        return normals_[n.index()].dot(tree.normal(t)) < 0.0 &&
               tree.box(t).squaredExteriorDistance(x) < reach * reach && n != a && n != b &&
               n != c && body.takes_part[t] != 0 &&
               squared_distance(x, positions[a.index()], positions[b.index()],
                                positions[c.index()]) < reach * reach &&
               !are_same_part(n, t);
    };
    const Vec3 margin = Vec3::Constant(reach);
    for (std::size_t begin = 0; begin < nodes.size(); begin += group_size) {
        const auto group = nodes.subspan(begin, std::min(group_size, nodes.size() - begin));
        Box box;
        NormalCone normals;
        for (const NodeId n : group) {
            box.extend(positions[n.index()]);
            normals.include({normals_[n.index()].stableNormalized(), 0.0});
        }
        near_group_.clear();
        tree.for_each_against(Box(box.min() - margin, box.max() + margin), normals,
                              [&](std::uint32_t t) { near_group_.push_back(t); });
        for (const NodeId n : group)
            for (const std::uint32_t t : near_group_)
                if (is_near(n, t)) found_.emplace_back(n, t);
    }
}

void TouchingPairs::take_found() {
    std::ranges::sort(found_);
    nodes_.clear();
    begin_.assign(1, 0);
    triangles_.clear();
    for (const auto& [n, t] : found_) {
        if (nodes_.empty() || nodes_.back() != n) {
            nodes_.push_back(n);
            begin_.push_back(triangles_.size());
        }
        triangles_.push_back(t);
        begin_.back() = triangles_.size();
    }
}

bool TouchingPairs::fits(std::size_t num_nodes, std::size_t num_triangles) const {
    return begin_.size() == nodes_.size() + 1 && begin_.front() == 0 &&
           begin_.back() == triangles_.size() && std::ranges::is_sorted(begin_) &&
           std::ranges::is_sorted(nodes_) &&
           std::ranges::all_of(nodes_,
                               [&](NodeId n) { return n.is_valid() && n.index() < num_nodes; }) &&
           std::ranges::all_of(triangles_, [&](std::uint32_t t) { return t < num_triangles; });
}

}  // namespace incise::contact
