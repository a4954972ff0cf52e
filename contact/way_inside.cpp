// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/way_inside.h"

#include <limits>
#include <optional>

namespace incise::contact {

namespace {

/// Returns through which face of an element a way leaves it, and at which part of the way: the
/// first plane of a face that it crosses outwards, as elements are convex. Nothing if the way ends
/// before.
std::optional<FaceId> exit_of(const topology::Mesh& mesh, std::span<const Vec3> positions,
                              ElementId element, const Vec3& from, const Vec3& along) {
    double least = 1.0;
    std::optional<FaceId> exit;
    for (int f = 0; f < mesh.num_faces(element); ++f) {
        const FaceId face{element, f};
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
                   const Vec3& from, const Vec3& to) {
    // Among elements that are turned inside out a way may go round in circles.
    constexpr int most_elements = 100;
    ElementId element = face.element;
    for (int i = 0; i < most_elements; ++i) {
        const auto exit = exit_of(mesh, positions, element, from, to - from);
        if (!exit) return true;
        const FaceId next = mesh.neighbor(*exit);
        if (!next.element.is_valid()) return false;
        element = next.element;
    }
    return false;
}

}  // namespace incise::contact
