// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/touching_pairs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/topology/geometry.h"

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
        const Vec3 area = topology::doubled_area(x, y, z);
        const double double_area = area.norm();
        if (!(double_area > 0.0)) continue;
        const Vec3 normal = area / double_area;
        const auto add = [&](VertexId n, const Vec3& a, const Vec3& b) {
            normals[n.index()] += std::atan2(double_area, a.dot(b)) * normal;
        };
        add(triangle[0], y - x, z - x);
        add(triangle[1], z - y, x - y);
        add(triangle[2], x - z, y - z);
    }
}

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

void append_fragment_corners(const ContactBody& body, VertexId n, std::vector<CellId>& star,
                             std::vector<NodeId>& corners) {
    body.mesh.star(n, star);
    for (const CellId cell : star) {
        const auto of_fragment = body.fragments.corners(body.fragments.fragment_of_cell(cell));
        corners.insert(corners.end(), of_fragment.begin(), of_fragment.end());
    }
}

void TouchingPairs::set_surface(const SurfaceTree& tree, const ContactBody& body) {
    set_node_normals(tree.triangles(), body.mesh.rest_positions(), rest_normals_);
    surface_nodes_.clear();
    std::vector<bool> is_listed(body.mesh.node_capacity(), false);
    for (const std::uint32_t t : tree.order()) {
        if (body.takes_part[t] == 0) continue;
        for (const VertexId n : tree.triangles()[t]) {
            if (is_listed[n.index()]) continue;
            is_listed[n.index()] = true;
            surface_nodes_.push_back(n);
        }
    }
    around_begin_.assign(body.mesh.node_capacity(), none_yet);
    around_.clear();
    is_around_.assign(body.fragments.node_capacity(), 0);
}

std::span<const NodeId> TouchingPairs::around(const ContactBody& body, VertexId n) {
    std::size_t& begin = around_begin_[n.index()];
    if (begin == none_yet) {
        corners_.clear();
        append_fragment_corners(body, n, star_, corners_);
        std::ranges::sort(corners_);
        corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
        begin = around_.size();
        around_.emplace_back(corners_.size());
        around_.insert(around_.end(), corners_.begin(), corners_.end());
    }
    return std::span(around_).subspan(begin + 1, around_[begin].index());
}

// Parts that are farther from each other than the elements round the node have no common corners.
// Nearer ones may touch only if they are the two sides of a cut, near its end: then their normals
// are against each other, and the node is on the triangle at rest.
bool TouchingPairs::are_sides_of_cut(const SurfaceTree& tree, const ContactBody& body, VertexId n,
                                     std::uint32_t t) const {
    const auto& [a, b, c] = tree.triangles()[t];
    const auto X = [&](VertexId m) { return body.mesh.rest_position(m); };
    const Vec3 normal = (X(b) - X(a)).cross(X(c) - X(a)), &of_node = rest_normals_[n.index()];
    const double double_area = normal.norm();
    constexpr double least_cosine = -0.5;
    if (of_node.dot(normal) > least_cosine * of_node.norm() * double_area) return false;
    constexpr double rounding_of_place = 1e-6;
    const double off = rounding_of_place * std::sqrt(double_area);
    return std::abs(normal.dot(X(n) - X(a))) <= off * double_area &&
           std::sqrt(squared_distance(X(n), X(a), X(b), X(c))) <= off;
}

void TouchingPairs::find(const SurfaceTree& tree, const ContactBody& body,
                         std::span<const Vec3> positions, double reach,
                         std::span<const NodeAndTriangle> touching) {
    found_.clear();
    set_node_normals(tree.triangles(), positions, normals_);
    append_pairs(tree, body, positions, reach, surface_nodes_, {});
    take_found(0, touching);
}

void TouchingPairs::find_again(const SurfaceTree& tree, const ContactBody& body,
                               std::span<const Vec3> positions, double reach,
                               std::span<const std::int32_t> number_of_old,
                               const std::function<bool(VertexId)>& is_chosen,
                               std::span<const NodeAndTriangle> touching) {
    found_.clear();
    std::vector<VertexId> chosen;
    for (const VertexId n : surface_nodes_) {
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
    set_node_normals(tree.triangles(), positions, normals_);
    append_pairs(tree, body, positions, reach, chosen, {});
    take_found(0, touching);
}

void TouchingPairs::find_moved(const SurfaceTree& tree, const ContactBody& body,
                               std::span<const Vec3> positions, double reach,
                               const MovedPart& moved, std::span<const NodeAndTriangle> touching) {
    found_.clear();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
        if (moved.is_node[nodes_[i].index()] != 0) continue;
        for (const std::uint32_t t : triangles_of(i))
            if (moved.is_triangle[t] == 0) found_.emplace_back(nodes_[i], t);
    }
    const std::size_t num_kept = found_.size();
    moved_nodes_.clear();
    near_moved_.clear();
    for (const VertexId n : surface_nodes_) {
        if (moved.is_node[n.index()] != 0)
            moved_nodes_.push_back(n);
        else if (moved.is_near[n.index()] != 0)
            near_moved_.push_back(n);
    }
    set_node_normals(tree.triangles(), positions, normals_);
    append_pairs(tree, body, positions, reach, moved_nodes_, {});
    append_pairs(tree, body, positions, reach, near_moved_, moved.is_triangle);
    take_found(num_kept, touching);
}

// Nodes that follow each other in the order of the tree are near each other: they look for
// triangles in groups.
void TouchingPairs::append_pairs(const SurfaceTree& tree, const ContactBody& body,
                                 std::span<const Vec3> positions, double reach,
                                 std::span<const VertexId> nodes,
                                 std::span<const std::uint8_t> is_triangle) {
    constexpr std::size_t group_size = 8;
    // The cheapest tests come first: of many triangles near a node, few can touch it.
    const auto is_near = [&](VertexId n, std::uint32_t t) {
        const Vec3& x = positions[n.index()];
        const auto& [a, b, c] = tree.triangles()[t];
        const auto X = [&](VertexId m) -> const Vec3& { return positions[m.index()]; };
        return normals_[n.index()].dot(tree.normal(t)) < 0.0 &&
               tree.box(t).squaredExteriorDistance(x) < reach * reach && n != a && n != b &&
               n != c && body.takes_part[t] != 0 && std::abs(tree.normal(t).dot(x - X(a))) < reach;
    };
    const auto is_touchable = [&](VertexId n, std::uint32_t t) {
        const ElementId fragment = body.fragments.fragment_of_cell(body.faces[t].cell);
        if (std::ranges::any_of(body.fragments.corners(fragment),
                                [&](NodeId corner) { return is_around_[corner.index()] != 0; }) &&
            !are_sides_of_cut(tree, body, n, t))
            return false;
        const auto X = [&](VertexId m) -> const Vec3& { return positions[m.index()]; };
        const auto& [a, b, c] = tree.triangles()[t];
        return squared_distance(X(n), X(a), X(b), X(c)) < reach * reach;
    };
    const Vec3 margin = Vec3::Constant(reach);
    for (std::size_t begin = 0; begin < nodes.size(); begin += group_size) {
        const auto group = nodes.subspan(begin, std::min(group_size, nodes.size() - begin));
        Box box;
        NormalCone normals;
        for (const VertexId n : group) {
            box.extend(positions[n.index()]);
            normals.include({normals_[n.index()].stableNormalized(), 0.0});
        }
        near_group_.clear();
        tree.for_each_against(Box(box.min() - margin, box.max() + margin), normals,
                              [&](std::uint32_t t) {
                                  if (is_triangle.empty() || is_triangle[t] != 0)
                                      near_group_.push_back(t);
                              });
        num_tested_ += group.size() * near_group_.size();
        for (const VertexId n : group) {
            near_node_.clear();
            for (const std::uint32_t t : near_group_)
                if (is_near(n, t)) near_node_.push_back(t);
            if (near_node_.empty()) continue;
            const auto corners = around(body, n);
            for (const NodeId corner : corners) is_around_[corner.index()] = 1;
            for (const std::uint32_t t : near_node_)
                if (is_touchable(n, t)) found_.emplace_back(n, t);
            for (const NodeId corner : corners) is_around_[corner.index()] = 0;
        }
    }
}

void TouchingPairs::take_found(std::size_t num_sorted, std::span<const NodeAndTriangle> touching) {
    found_.insert(found_.end(), touching.begin(), touching.end());
    const auto middle = found_.begin() + static_cast<std::ptrdiff_t>(num_sorted);
    std::sort(middle, found_.end());
    std::inplace_merge(found_.begin(), middle, found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
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
                               [&](VertexId n) { return n.is_valid() && n.index() < num_nodes; }) &&
           std::ranges::all_of(triangles_, [&](std::uint32_t t) { return t < num_triangles; });
}

}  // namespace incise::contact
