// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/way_inside.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace incise::contact {

namespace {

/// A point on the surface is not within it, though rounding may say so. It is a part of the way.
constexpr double margin = 1e-6;

/// Returns through which face of an element a way leaves it: the first plane of a face that it
/// crosses outwards, as if the element were convex. Nothing if the way ends before.
/// @param entered  the face by which it came, and does not leave
std::optional<FaceId> exit_of(const topology::Mesh& mesh, std::span<const Vec3> positions,
                              FaceId entered, const Vec3& from, const Vec3& along) {
    double least = 1.0 + margin;
    std::optional<FaceId> exit;
    for (int f = 0; f < mesh.num_faces(entered.element); ++f) {
        const FaceId face{entered.element, f};
        if (face == entered) continue;
        const auto at = [&](int k) { return positions[mesh.face_corner(face, k).index()]; };
        for (int k = 2; k < mesh.face_size(face); ++k) {
            const Vec3 outward = (at(k - 1) - at(0)).cross(at(k) - at(0));
            const double rise = along.dot(outward);
            if (!(rise > 0.0)) continue;
            const double part = (at(0) - from).dot(outward) / rise;
            if (part >= least) continue;
            least = part;
            exit = face;
        }
    }
    return exit;
}

}  // namespace

bool is_way_inside(const topology::Mesh& mesh, std::span<const Vec3> positions, FaceId face,
                   const std::array<NodeId, 3>& triangle, const Vec3& weights, const Vec3& to) {
    constexpr double least_weight = 0.01;
    const Vec3 inner = weights.cwiseMax(least_weight) / weights.cwiseMax(least_weight).sum();
    Vec3 from = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        from += inner[k] * positions[triangle[static_cast<std::size_t>(k)].index()];
    // Among elements that are turned inside out a way may go round in circles.
    constexpr int most_elements = 100;
    FaceId entered = face;
    for (int i = 0; i < most_elements; ++i) {
        const auto exit = exit_of(mesh, positions, entered, from, to - from);
        if (!exit) {
            // Beyond a corner of the surface the way may go on inside.
            const double square = margin * margin * (to - from).squaredNorm();
            return std::ranges::none_of(mesh.corners(entered.element), [&](NodeId n) {
                return (positions[n.index()] - to).squaredNorm() <= square;
            });
        }
        entered = mesh.neighbor(*exit);
        if (!entered.is_valid()) return false;
    }
    return false;
}

}  // namespace incise::contact
