// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/surface_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "incise/topology/geometry.h"

namespace incise::contact {

namespace {

double angle_between(const Vec3& a, const Vec3& b) {
    return std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

/// Returns the bits of a 21-bit number with two zeros between each and the next.
std::uint64_t spread(std::uint64_t bits) {
    bits &= 0x1fffff;
    bits = (bits | bits << 32) & 0x1f00000000ffff;
    bits = (bits | bits << 16) & 0x1f0000ff0000ff;
    bits = (bits | bits << 8) & 0x100f00f00f00f00f;
    bits = (bits | bits << 4) & 0x10c30c30c30c30c3;
    bits = (bits | bits << 2) & 0x1249249249249249;
    return bits;
}

/// Returns the number of a point along Morton's curve through a box.
std::uint64_t place_along_curve(const Vec3& x, const Box& box) {
    constexpr double last = 0x1fffff;
    const double size = box.sizes().maxCoeff();
    std::uint64_t place = 0;
    for (int c = 0; c < 3; ++c) {
        const double share = size > 0.0 ? (x[c] - box.min()[c]) / size : 0.0;
        place |= spread(static_cast<std::uint64_t>(std::clamp(share, 0.0, 1.0) * last)) << c;
    }
    return place;
}

}  // namespace

void NormalCone::include(const NormalCone& other) {
    if (other.half_angle < 0.0) return;
    if (half_angle < 0.0) {
        *this = other;
        return;
    }
    const Vec3 sum = axis + other.axis;
    const double length = sum.norm();
    if (length < 1e-6) {
        half_angle = std::numbers::pi;
        return;
    }
    const Vec3 mean = sum / length;
    half_angle = std::min(std::max(angle_between(mean, axis) + half_angle,
                                   angle_between(mean, other.axis) + other.half_angle),
                          std::numbers::pi);
    axis = mean;
}

SurfaceTree::Directions::Directions(const NormalCone& cone)
    : axis(cone.axis),
      // Of no triangles: they oppose nothing.
      cosine(cone.half_angle < 0.0 ? 1.0 : std::cos(cone.half_angle)),
      sine(cone.half_angle < 0.0 ? 0.0 : std::sin(cone.half_angle)) {}

void SurfaceTree::set_triangles(std::span<const Triangle> triangles,
                                std::span<const Vec3> rest_positions) {
    triangles_.assign(triangles.begin(), triangles.end());
    Box box;
    for (const Triangle& triangle : triangles_)
        for (const VertexId n : triangle) box.extend(rest_positions[n.index()]);
    std::vector<std::pair<std::uint64_t, std::uint32_t>> places;
    places.reserve(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
        Vec3 sum = Vec3::Zero();
        for (const VertexId n : triangles_[t]) sum += rest_positions[n.index()];
        places.emplace_back(place_along_curve(sum / 3.0, box), t);
    }
    std::ranges::sort(places);
    order_.clear();
    for (const auto& [place, t] : places) order_.push_back(t);
    num_leaves_ =
        std::bit_ceil(std::max<std::size_t>((order_.size() + leaf_size - 1) / leaf_size, 1));
    branches_.resize(2 * num_leaves_);
    boxes_.resize(triangles_.size());
    normals_.resize(triangles_.size());
}

void SurfaceTree::fit(std::span<const Vec3> positions) {
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
        const auto& [a, b, c] = triangles_[t];
        const Vec3 &x = positions[a.index()], &y = positions[b.index()], &z = positions[c.index()];
        boxes_[t] = Box(x.cwiseMin(y).cwiseMin(z), x.cwiseMax(y).cwiseMax(z));
        normals_[t] = topology::doubled_area(x, y, z).stableNormalized();
    }
    cones_.assign(branches_.size(), {});
    for (std::size_t k = 2 * num_leaves_ - 1; k >= 1; --k) {
        Box box;
        NormalCone& cone = cones_[k];
        if (k < num_leaves_) {
            for (const std::size_t child : {2 * k, 2 * k + 1}) {
                box.extend(branches_[child].box);
                cone.include(cones_[child]);
            }
        } else {
            for (std::size_t i = leaf_begin(k); i < leaf_end(k); ++i) {
                box.extend(boxes_[order_[i]]);
                cone.include({normals_[order_[i]], 0.0});
            }
        }
        branches_[k] = {box, Directions(cone)};
    }
}

}  // namespace incise::contact
