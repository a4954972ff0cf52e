// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/triangle_surface.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <limits>
#include <unsupported/Eigen/BVH>
#include <utility>

#include "incise/cutting/surfaces/shifted_sign.h"

namespace incise::cutting {

namespace {

using Triangle = std::array<Vec3, 3>;

Box box_of(const Triangle& t) {
    Box box(t[0]);
    box.extend(t[1]).extend(t[2]);
    return box;
}

ShiftedPoint<3> point(const Vec3& x, bool is_tissue) { return {{x.x(), x.y(), x.z()}, is_tissue}; }

/// Returns the edge parameter at which the segment of tissue from a to b passes through the
/// triangle, or a negative number if it does not.
double crossing(const Vec3& a, const Vec3& b, const Triangle& triangle) {
    const auto from = point(a, true), to = point(b, true);
    const auto u = point(triangle[0], false), v = point(triangle[1], false),
               w = point(triangle[2], false);
    const int below = orientation_sign<3>({&from, &u, &v, &w});
    if (below == 0 || orientation_sign<3>({&to, &u, &v, &w}) != -below) return -1.0;
    const int turn = orientation_sign<3>({&from, &to, &u, &v});
    if (turn == 0 || orientation_sign<3>({&from, &to, &v, &w}) != turn ||
        orientation_sign<3>({&from, &to, &w, &u}) != turn)
        return -1.0;
    const double depth = std::abs(orientation_value<3>({&from, &u, &v, &w})),
                 height = depth + std::abs(orientation_value<3>({&to, &u, &v, &w}));
    return height > 0.0 ? depth / height : 0.5;
}

/// Returns the squared distance of x from the triangle: from its inside if x is over it, else from
/// its edges.
double squared_distance(const Vec3& x, const Triangle& t) {
    const Vec3 normal = (t[1] - t[0]).cross(t[2] - t[0]);
    const double square = normal.squaredNorm();
    bool is_over_inside = square > 0.0;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 edge = t[(k + 1) % 3] - t[k], from = x - t[k];
        is_over_inside = is_over_inside && normal.dot(edge.cross(from)) >= 0.0;
        const double length = edge.squaredNorm();
        const double s = length > 0.0 ? std::clamp(from.dot(edge) / length, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, (from - s * edge).squaredNorm());
    }
    if (!is_over_inside) return nearest;
    const double height = normal.dot(x - t[0]);
    return height * height / square;
}

struct AnyInBox {
    Box box;
    bool found = false;
    bool intersectVolume(const Box& volume) const { return box.intersects(volume); }
    bool intersectObject(const Triangle& t) {
        found = box.intersects(box_of(t));
        return found;  // true ends the search
    }
};

struct AnyWithin {
    const Vec3& x;
    double square;
    Box box;
    bool found = false;
    bool intersectVolume(const Box& volume) const { return box.intersects(volume); }
    bool intersectObject(const Triangle& t) {
        found = squared_distance(x, t) <= square;
        return found;
    }
};

struct NearestWithin {
    const Vec3& x;
    double square;
    Box box;
    Vec3 normal = Vec3::Zero();
    bool intersectVolume(const Box& volume) const { return box.intersects(volume); }
    bool intersectObject(const Triangle& t) {
        const Vec3 across = (t[1] - t[0]).cross(t[2] - t[0]);
        if (across.isZero(0.0)) return false;  // a triangle without area cuts nothing
        if (const double found = squared_distance(x, t); found <= square) {
            square = found;
            normal = across.normalized();
        }
        return false;
    }
};

struct CrossingsOf {
    const Vec3 &a, &b;
    std::vector<Crossing>& crossings;
    Box box;
    bool intersectVolume(const Box& volume) const { return box.intersects(volume); }
    bool intersectObject(const Triangle& t) const {
        if (const double place = crossing(a, b, t); place >= 0.0)
            crossings.push_back({place, (t[1] - t[0]).cross(t[2] - t[0])});
        return false;
    }
};

/// Returns a hash of the coordinates of all corners, in their order. Another surface has the same
/// one with a probability of 2^-64.
SurfaceIdentity identity_of(const std::vector<Triangle>& triangles) {
    std::uint64_t number = 0xCBF29CE484222325u;
    for (const Triangle& t : triangles)
        for (const Vec3& x : t)
            for (const double coordinate : x) {
                number ^= std::bit_cast<std::uint64_t>(coordinate);
                number *= 0x9E3779B97F4A7C15u;
                number ^= number >> 29;
            }
    return std::max(number, identity_of_planes + 1);
}

struct DistanceFrom {
    using Scalar = double;
    const Vec3& x;
    double minimumOnVolume(const Box& volume) const { return volume.squaredExteriorDistance(x); }
    double minimumOnObject(const Triangle& t) const { return squared_distance(x, t); }
};

using TriangleTree = Eigen::KdBVH<double, 3, Triangle>;

void fill(TriangleTree& tree, const std::vector<Triangle>& triangles) {
    std::vector<Box> boxes;
    std::ranges::transform(triangles, std::back_inserter(boxes), box_of);
    if (!triangles.empty())
        tree.init(triangles.begin(), triangles.end(), boxes.begin(), boxes.end());
}

/// Returns the edges of an odd number of triangles, as triangles without area.
std::vector<Triangle> boundary_of(const std::vector<Triangle>& triangles) {
    const auto is_before = [](const Vec3& a, const Vec3& b) {
        return std::ranges::lexicographical_compare(a, b);
    };
    using Segment = std::pair<Vec3, Vec3>;
    std::vector<Segment> edges;
    for (const Triangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = t[k], &b = t[(k + 1) % 3];
            edges.push_back(is_before(b, a) ? Segment{b, a} : Segment{a, b});
        }
    std::ranges::sort(edges, [&](const Segment& s, const Segment& t) {
        return s.first == t.first ? is_before(s.second, t.second) : is_before(s.first, t.first);
    });
    std::vector<Triangle> boundary;
    for (std::size_t begin = 0; begin < edges.size();) {
        std::size_t end = begin;
        while (end < edges.size() && edges[end] == edges[begin]) ++end;
        if ((end - begin) % 2 == 1)
            boundary.push_back({edges[begin].first, edges[begin].second, edges[begin].second});
        begin = end;
    }
    return boundary;
}

}  // namespace

struct TriangleSurface::Tree {
    TriangleTree bvh, boundary;
    bool is_empty = true, has_boundary = false;
};

TriangleSurface::TriangleSurface(const topology::SurfaceData& surface)
    : tree_(std::make_unique<Tree>()) {
    std::vector<Triangle> triangles;
    for (const auto& corners : surface.triangles) {
        const auto at = [&](std::size_t k) {
            return surface.points[static_cast<std::size_t>(corners[k])];
        };
        triangles.push_back({at(0), at(1), at(2)});
    }
    identity_ = identity_of(triangles);
    tree_->is_empty = triangles.empty();
    fill(tree_->bvh, triangles);
    const std::vector<Triangle> boundary = boundary_of(triangles);
    tree_->has_boundary = !boundary.empty();
    fill(tree_->boundary, boundary);
}

TriangleSurface::~TriangleSurface() = default;

bool TriangleSurface::may_meet(const Box& box) const {
    if (tree_->is_empty) return false;
    AnyInBox query{box};
    Eigen::BVIntersect(tree_->bvh, query);
    return query.found;
}

void TriangleSurface::append_crossings(const MovingPoint& a, const MovingPoint& b,
                                       std::vector<Crossing>& crossings) const {
    if (tree_->is_empty) return;
    Box box(a[1]);
    box.extend(b[1]);
    CrossingsOf query{a[1], b[1], crossings, box};
    Eigen::BVIntersect(tree_->bvh, query);
}

bool TriangleSurface::comes_within(const Vec3& x, double distance) const {
    if (tree_->is_empty) return false;
    const Vec3 reach = Vec3::Constant(distance);
    AnyWithin query{x, distance * distance, Box(x - reach, x + reach)};
    Eigen::BVIntersect(tree_->bvh, query);
    return query.found;
}

std::optional<Vec3> TriangleSurface::normal_near(const Vec3& x, double distance) const {
    if (tree_->is_empty) return std::nullopt;
    const Vec3 reach = Vec3::Constant(distance);
    const Box box(x - reach, x + reach);
    if (tree_->has_boundary) {
        AnyWithin is_at_boundary{x, distance * distance, box};
        Eigen::BVIntersect(tree_->boundary, is_at_boundary);
        if (is_at_boundary.found) return std::nullopt;
    }
    NearestWithin query{x, distance * distance, box};
    Eigen::BVIntersect(tree_->bvh, query);
    return query.normal.isZero(0.0) ? std::nullopt : std::optional(query.normal);
}

double TriangleSurface::distance(const Vec3& x) const {
    if (tree_->is_empty) return std::numeric_limits<double>::infinity();
    DistanceFrom query{x};
    return std::sqrt(Eigen::BVMinimize(tree_->bvh, query));
}

}  // namespace incise::cutting
