// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/rigid_solid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace incise::contact {

namespace {

Vec3 combined(const std::array<Vec3, 3>& x, const Vec3& weights) {
    return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
}

const NormalCone all_directions{Vec3::UnitZ(), std::numbers::pi};

Box box_round(const Vec3& x, double distance) {
    const Vec3 margin = Vec3::Constant(distance);
    return {x - margin, x + margin};
}

}  // namespace

// Source: Baerentzen, Aanaes 2005: with normals that are weighted by angles, the side of the
// nearest point tells what is inside.
RigidSolid::RigidSolid(const cutting::Solid& solid) : points_(solid.surface.points) {
    for (const auto& [a, b, c] : solid.surface.triangles)
        triangles_.push_back({VertexId(static_cast<std::size_t>(a)),
                              VertexId(static_cast<std::size_t>(b)),
                              VertexId(static_cast<std::size_t>(c))});
    for (const Vec3& x : points_) extent_.extend(x);
    tree_.set_triangles(triangles_, points_);
    tree_.fit(points_);
    point_normals_.assign(points_.size(), Vec3::Zero());
    points_of_.resize(triangles_.size());
    edges_of_.resize(triangles_.size());
    std::vector<bool> is_listed(points_.size(), false);
    std::map<std::pair<VertexId, VertexId>, Vec3> of_edge;
    for (std::size_t t = 0; t < triangles_.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const VertexId a = triangles_[t][k], b = triangles_[t][(k + 1) % 3],
                           c = triangles_[t][(k + 2) % 3];
            const Vec3 to_b = (points_[b.index()] - points_[a.index()]).normalized();
            const Vec3 to_c = (points_[c.index()] - points_[a.index()]).normalized();
            const double angle = std::acos(std::clamp(to_b.dot(to_c), -1.0, 1.0));
            point_normals_[a.index()] += angle * tree_.normal(t);
            if (!is_listed[a.index()]) points_of_[t].push_back(a);
            is_listed[a.index()] = true;
            const auto [it, is_new] = of_edge.try_emplace(std::minmax(a, b), tree_.normal(t));
            if (is_new) continue;
            // The third corner is below the plane of the other triangle.
            constexpr double least_sine = 1e-3;
            if (it->second.dot(to_c) < -least_sine * to_b.cross(to_c).norm()) {
                edges_of_[t].push_back(edges_.size());
                edges_.push_back({a, b, {it->second, tree_.normal(t)}});
            }
            it->second += tree_.normal(t);
        }
    for (const Triangle& triangle : triangles_) {
        auto& normals = edge_normals_.emplace_back();
        for (std::size_t k = 0; k < 3; ++k)
            normals[k] = of_edge.at(std::minmax(triangle[k], triangle[(k + 1) % 3]));
    }
}

RigidSolid::Corners RigidSolid::corners_of(std::uint32_t triangle) const {
    Corners corners;
    for (std::size_t k = 0; k < 3; ++k) corners[k] = points_[triangles_[triangle][k].index()];
    return corners;
}

/// Finds the nearest point of the surface within a distance. Returns false if there is none.
bool RigidSolid::find_nearest(const Vec3& x, double farthest, Nearest& nearest) const {
    constexpr double rounding = 1e-9;
    double least = farthest * farthest;
    bool is_found = false;
    tree_.for_each_against(box_round(x, farthest), all_directions, [&](std::uint32_t t) {
        const Corners corners = corners_of(t);
        const Vec3 weights = closest_weights(corners, x);
        const Vec3 point = combined(corners, weights);
        const double square = (point - x).squaredNorm();
        if (square >= least) return;
        least = square;
        is_found = true;
        nearest.point = point;
        std::size_t num_zero = 0, zero = 0, one = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool is_zero = weights[static_cast<int>(k)] <= rounding;
            num_zero += is_zero;
            (is_zero ? zero : one) = k;
        }
        if (num_zero == 0)
            nearest.normal = tree_.normal(t);
        else if (num_zero == 1)
            nearest.normal = edge_normals_[t][(zero + 1) % 3];
        else
            nearest.normal = point_normals_[triangles_[t][one].index()];
    });
    return is_found;
}

/// Of a point inside, takes the nearest face that faces its triangle, if it is not much farther
/// than the nearest one of all. Near an edge that is pressed into tissue, the nearest one may be
/// beside the tissue in one step and not in the next one.
void RigidSolid::leave_by_facing_side(const Vec3& x, const Vec3& outward, double farthest,
                                      Nearest& nearest) const {
    constexpr double least_cosine = 0.5;
    double least = farthest;
    tree_.for_each_against(box_round(x, farthest), all_directions, [&](std::uint32_t t) {
        const Vec3& normal = tree_.normal(t);
        if (-normal.dot(outward) < least_cosine) return;
        const Corners corners = corners_of(t);
        const double depth = normal.dot(corners[0] - x);
        if (depth < 0.0 || depth >= least) return;
        const Vec3 point = x + depth * normal;
        if ((combined(corners, closest_weights(corners, point)) - point).norm() > 1e-9 * farthest)
            return;
        least = depth;
        nearest = {point, normal};
    });
}

void RigidSolid::append_corner(const Corners& corners, int k, const Vec3& outward, double farthest,
                               std::vector<RigidTouch>& touches) const {
    const Vec3& x = corners[static_cast<std::size_t>(k)];
    Nearest nearest;
    if (!find_nearest(x, farthest, nearest)) {
        // Deep inside it counts as well.
        if (!extent_.contains(x) || !find_nearest(x, extent_.diagonal().norm(), nearest) ||
            (x - nearest.point).dot(nearest.normal) > 0.0)
            return;
    }
    const bool is_outside = (x - nearest.point).dot(nearest.normal) >= 0.0;
    if (!is_outside) {
        constexpr double edge_reach = 0.1;  // of the longest edge of the triangle
        double longest = 0.0;
        for (const Vec3& other : corners) longest = std::max(longest, (other - x).norm());
        leave_by_facing_side(x, outward, (nearest.point - x).norm() + edge_reach * longest,
                             nearest);
    }
    const Vec3 away = x - nearest.point;
    const double distance = away.norm();
    // On the surface itself, only the normal tells the direction.
    const Vec3 normal = distance > 1e-9 * farthest ? Vec3((is_outside ? away : -away) / distance)
                                                   : nearest.normal.normalized();
    touches.push_back({Vec3::Unit(k), nearest.point, normal, is_outside ? distance : -distance});
}

void RigidSolid::append_point(const Corners& corners, const Vec3& outward, VertexId p,
                              double farthest, std::vector<RigidTouch>& touches) const {
    // A point that faces the same way is on the other side of the tool.
    if (point_normals_[p.index()].dot(outward) >= 0.0) return;
    const Vec3& x = points_[p.index()];
    const Vec3 weights = closest_weights(corners, x);
    const Vec3 away = combined(corners, weights) - x;
    const double distance = away.norm();
    const bool is_inside = away.dot(outward) > 0.0;
    // Beside the triangle, others decide whether a point is in the tissue.
    if (distance > farthest ||
        (is_inside && distance > away.dot(outward) * (1.0 + 1e-6) + 1e-12 * farthest))
        return;
    const Vec3 normal =
        is_inside || !(distance > 1e-9 * farthest) ? Vec3(-outward) : Vec3(away / distance);
    touches.push_back(
        {weights, x, normal, is_inside ? -distance : distance, static_cast<std::int32_t>(p.value)});
}

/// Appends where an edge of the surface crosses edges of a triangle. The normal is at right angles
/// to both.
void RigidSolid::append_edge(const Corners& corners, const Vec3& outward, std::size_t edge,
                             double farthest, std::vector<RigidTouch>& touches) const {
    constexpr double end = 1e-6, least_sine = 1e-3;
    const auto& [from, to, normals] = edges_[edge];
    const Vec3 &p = points_[from.index()], &q = points_[to.index()];
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 &a = corners[k], &b = corners[(k + 1) % 3];
        const auto [s, t] = closest_of_segments(a, b, p, q);
        if (std::min(s, t) < end || std::max(s, t) > 1.0 - end) continue;
        Vec3 normal = (b - a).cross(q - p);
        const double length = normal.norm();
        if (!(length > least_sine * (b - a).norm() * (q - p).norm())) continue;
        normal *= (normal.dot(normals[0] + normals[1]) < 0.0 ? -1.0 : 1.0) / length;
        const double cosine = normals[0].dot(normals[1]);
        if (normal.dot(normals[0]) < cosine || normal.dot(normals[1]) < cosine ||
            normal.dot(outward) >= 0.0)
            continue;
        const Vec3 on_edge = p + t * (q - p), on_triangle = a + s * (b - a);
        const double gap = normal.dot(on_triangle - on_edge);
        if (std::abs(gap) > farthest) continue;
        Nearest nearest;
        if (gap < 0.0 && (!find_nearest(on_triangle, 2.0 * farthest, nearest) ||
                          (on_triangle - nearest.point).dot(nearest.normal) > 0.0))
            continue;
        Vec3 weights = Vec3::Zero();
        weights[static_cast<int>(k)] = 1.0 - s;
        weights[static_cast<int>((k + 1) % 3)] = s;
        touches.push_back(
            {weights, on_edge, normal, gap, static_cast<std::int32_t>(points_.size() + edge)});
    }
}

void RigidSolid::append_touches(const Corners& corners, double farthest,
                                std::vector<RigidTouch>& touches) const {
    const Vec3 area = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    if (!(area.squaredNorm() > 0.0)) return;
    const Vec3 outward = area.normalized();
    for (int k = 0; k < 3; ++k) append_corner(corners, k, outward, farthest, touches);
    Box box;
    for (const Vec3& x : corners) box.extend(x);
    const Vec3 margin = Vec3::Constant(farthest);
    const Box near(box.min() - margin, box.max() + margin);
    tree_.for_each_against(near, all_directions, [&](std::uint32_t t) {
        for (const VertexId p : points_of_[t]) append_point(corners, outward, p, farthest, touches);
        for (const std::size_t e : edges_of_[t])
            append_edge(corners, outward, e, farthest, touches);
    });
}

}  // namespace incise::contact
