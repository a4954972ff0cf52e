// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/surface_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <sstream>
#include <unsupported/Eigen/BVH>
#include <utility>

#include "incise/cutting/surfaces/cut_surface.h"

namespace incise::cutting {

namespace {

/// A triangle: the numbers of the positions of its corners, and these positions.
struct PlacedTriangle {
    std::array<std::size_t, 3> places;
    std::array<Vec3, 3> corners;
};

/// Returns the side of the triangle u, v, w on which the point is, or 0 if the point is in its
/// plane to rounding errors.
int side(const Vec3& p, const Vec3& u, const Vec3& v, const Vec3& w) {
    constexpr double tolerance = 1e-13;
    const Vec3 a = v - u, b = w - u, c = p - u;
    const double height = a.cross(b).dot(c);
    const double rounding =
        tolerance * std::sqrt(a.squaredNorm() * b.squaredNorm() * c.squaredNorm());
    return height > rounding ? 1 : height < -rounding ? -1 : 0;
}

/// Returns the triangles that have an area. All points at one position have one number.
std::vector<PlacedTriangle> placed_triangles(const topology::SurfaceData& surface) {
    std::map<std::array<double, 3>, std::size_t> numbers;
    std::vector<PlacedTriangle> triangles;
    for (const auto& corners : surface.triangles) {
        PlacedTriangle t;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& x = t.corners[k] = surface.points[static_cast<std::size_t>(corners[k])];
            t.places[k] = numbers.try_emplace({x.x(), x.y(), x.z()}, numbers.size()).first->second;
        }
        const auto& [a, b, c] = t.corners;
        if ((b - a).cross(c - a).squaredNorm() > 0.0) triangles.push_back(t);
    }
    return triangles;
}

/// Returns a point off the plane of the triangle. With it, side() gives the orientation of three
/// points in that plane.
Vec3 apex_over(const PlacedTriangle& t) {
    const Vec3 u = t.corners[1] - t.corners[0], v = t.corners[2] - t.corners[0];
    return t.corners[0] + std::max(u.norm(), v.norm()) * u.cross(v).normalized();
}

/// True if an edge of `t` has no corner of the other triangle on its inner side. Both triangles are
/// in one plane.
bool has_separating_edge(const PlacedTriangle& t, const PlacedTriangle& other, const Vec3& apex) {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto &a = t.corners[k], &b = t.corners[(k + 1) % 3];
        const int inner = side(apex, a, b, t.corners[(k + 2) % 3]);
        if (std::none_of(other.corners.begin(), other.corners.end(),
                         [&](const auto& p) { return side(apex, a, b, p) == inner; }))
            return true;
    }
    return false;
}

/// True if the edge from p to q passes through the triangle. An edge that ends in the plane of the
/// triangle does so if this end is inside the triangle, not on its boundary. An edge in the plane
/// does not.
bool passes_through(const Vec3& p, int side_of_p, const Vec3& q, int side_of_q,
                    const PlacedTriangle& t) {
    if (side_of_p == side_of_q) return false;
    const bool is_through = side_of_p * side_of_q < 0;
    int turn = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const int sign = side(p, q, t.corners[k], t.corners[(k + 1) % 3]);
        if (sign == 0 && !is_through) return false;
        if (sign * turn < 0) return false;
        if (sign != 0) turn = sign;
    }
    return true;
}

enum class Meeting { none, passing, lying_upon };

/// True if an edge of s passes through t. Sets `are_coplanar` to whether both are in one plane.
bool has_edge_through(const PlacedTriangle& s, const PlacedTriangle& t, bool& are_coplanar) {
    std::array<int, 3> sides{};
    std::array<bool, 3> is_shared{};
    for (std::size_t k = 0; k < 3; ++k) {
        is_shared[k] = std::find(t.places.begin(), t.places.end(), s.places[k]) != t.places.end();
        if (!is_shared[k]) sides[k] = side(s.corners[k], t.corners[0], t.corners[1], t.corners[2]);
    }
    are_coplanar = sides == std::array<int, 3>{};
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t l = (k + 1) % 3;
        if (is_shared[k] || is_shared[l]) continue;  // the corner belongs to both
        if (passes_through(s.corners[k], sides[k], s.corners[l], sides[l], t)) return true;
    }
    return false;
}

Meeting meeting(const PlacedTriangle& s, const PlacedTriangle& t) {
    bool are_coplanar = false;
    if (has_edge_through(s, t, are_coplanar)) return Meeting::passing;
    if (are_coplanar) {
        const auto apex = apex_over(s);
        const bool are_apart = has_separating_edge(s, t, apex) || has_separating_edge(t, s, apex);
        return are_apart ? Meeting::none : Meeting::lying_upon;
    }
    return has_edge_through(t, s, are_coplanar) ? Meeting::passing : Meeting::none;
}

Vec3 centre(const PlacedTriangle& t) { return (t.corners[0] + t.corners[1] + t.corners[2]) / 3.0; }

std::string place(const Vec3& x) {
    std::ostringstream text;
    text.precision(6);
    text << "(" << x.x() << ", " << x.y() << ", " << x.z() << ")";
    return text.str();
}

/// A search for the first pair of triangles of each kind of meeting, for Eigen::BVIntersect.
struct MeetingPairs {
    const std::vector<PlacedTriangle>& triangles;
    const PlacedTriangle *passing = nullptr, *lying_upon = nullptr;

    bool intersectVolumeVolume(const Box& a, const Box& b) const { return a.intersects(b); }
    bool intersectVolumeObject(const Box& a, int t) const { return a.intersects(box_of(t)); }
    bool intersectObjectVolume(int s, const Box& b) const { return b.intersects(box_of(s)); }
    bool intersectObjectObject(int s, int t) {
        if (s >= t || !box_of(s).intersects(box_of(t))) return false;
        const auto& first = at(s);
        const Meeting found = meeting(first, at(t));
        if (found == Meeting::passing && !passing) passing = &first;
        if (found == Meeting::lying_upon && !lying_upon) lying_upon = &first;
        return passing && lying_upon;
    }

    const PlacedTriangle& at(int t) const { return triangles[static_cast<std::size_t>(t)]; }
    Box box_of(int t) const {
        Box box;
        for (const auto& corner : at(t).corners) box.extend(corner);
        return box;
    }
};

}  // namespace

std::vector<std::string> defects_of_surface(const topology::SurfaceData& surface) {
    const auto triangles = placed_triangles(surface);
    if (triangles.empty()) return {};
    const std::string consequence =
        ": there a cut may leave tissue joined; give the sheets that meet as cuts of their own";
    std::vector<std::string> defects;

    std::map<std::pair<std::size_t, std::size_t>, int> num_triangles_of;
    std::size_t num_branches = 0;
    Vec3 first_branch = Vec3::Zero();
    for (const auto& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t l = (k + 1) % 3;
            int& count = num_triangles_of[std::minmax(t.places[k], t.places[l])];
            if (++count != 3) continue;
            if (num_branches++ == 0) first_branch = 0.5 * (t.corners[k] + t.corners[l]);
        }
    if (num_branches > 0)
        defects.push_back("more than two triangles share " + std::to_string(num_branches) +
                          (num_branches == 1 ? " edge" : " edges, the first") + " at " +
                          place(first_branch) + consequence);

    MeetingPairs pairs{triangles};
    std::vector<int> numbers(triangles.size());
    std::vector<Box> boxes;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        numbers[i] = static_cast<int>(i);
        boxes.push_back(pairs.box_of(numbers[i]));
    }
    const Eigen::KdBVH<double, 3, int> tree(numbers.begin(), numbers.end(), boxes.begin(),
                                            boxes.end());
    Eigen::BVIntersect(tree, tree, pairs);
    if (pairs.passing)
        defects.push_back("triangles pass through each other, one near " +
                          place(centre(*pairs.passing)) + consequence);
    if (pairs.lying_upon)
        defects.push_back("triangles lie upon each other, one near " +
                          place(centre(*pairs.lying_upon)) + consequence);
    return defects;
}

}  // namespace incise::cutting
