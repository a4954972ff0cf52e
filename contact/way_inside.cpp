// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/way_inside.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "incise/topology/face_triangles.h"
#include "incise/topology/geometry.h"

namespace incise::contact {

namespace {

/// By how much a way may leave an element before its end, for which rounding may be the cause. It
/// is a part of the way.
constexpr double margin = 1e-6;
/// A point that is so near to the surface is on it, and not within the body. Overlaps may begin
/// with little more. It is a part of the way.
constexpr double on_surface = 1e-10;
/// Among elements that are turned inside out a way may go round in circles.
constexpr std::size_t most_elements = 100;

/// Calls visit(point, outward) for the planes of the triangles of a face. A face of a polyhedron
/// can have triangles without area, between corners on a straight line: they have no plane.
template <class Visit>
void for_each_plane(const topology::Mesh& mesh, std::span<const Vec3> positions, FaceId face,
                    Visit visit) {
    topology::for_each_triangle(mesh, face, [&](VertexId a, VertexId b, VertexId c) {
        const Vec3& point = positions[a.index()];
        const Vec3 outward =
            topology::doubled_area(point, positions[b.index()], positions[c.index()]);
        if (!outward.isZero(0.0)) visit(point, outward);
    });
}

/// Returns through which face of an element a way leaves it: the first plane of a face that it
/// crosses outwards, as if the element were convex. Nothing if the way ends before.
/// @param entered  the face by which it came, and does not leave
std::optional<FaceId> exit_of(const topology::Mesh& mesh, std::span<const Vec3> positions,
                              FaceId entered, const Vec3& from, const Vec3& along) {
    double least = 1.0 + margin;
    std::optional<FaceId> exit;
    for (int f = 0; f < mesh.num_faces(entered.cell); ++f) {
        const FaceId face{entered.cell, f};
        if (face == entered) continue;
        for_each_plane(mesh, positions, face, [&](const Vec3& point, const Vec3& outward) {
            const double rise = along.dot(outward);
            if (!(rise > 0.0)) return;
            const double part = (point - from).dot(outward) / rise;
            if (part >= least) return;
            least = part;
            exit = face;
        });
    }
    return exit;
}

/// True if a point of an element is on the surface. From the element on, those are looked at that
/// have it in common: it may be on an edge or at a corner of the surface, at which the element has
/// no face of the surface.
/// @param distance  at which it counts as on a face, m
bool is_on_surface(const topology::Mesh& mesh, std::span<const Vec3> positions, CellId element,
                   const Vec3& point, double distance) {
    std::vector<CellId> elements{element};
    for (std::size_t i = 0; i < elements.size() && i < most_elements; ++i)
        for (int f = 0; f < mesh.num_faces(elements[i]); ++f) {
            const FaceId face{elements[i], f};
            bool is_on_face = false;
            for_each_plane(mesh, positions, face, [&](const Vec3& on_it, const Vec3& outward) {
                is_on_face |= (point - on_it).dot(outward) >= -distance * outward.norm();
            });
            if (!is_on_face) continue;
            const FaceId neighbor = mesh.neighbor(face);
            if (!neighbor.is_valid()) return true;
            if (std::ranges::find(elements, neighbor.cell) == elements.end())
                elements.push_back(neighbor.cell);
        }
    return false;
}

}  // namespace

bool is_way_inside(const topology::Mesh& mesh, std::span<const Vec3> positions, FaceId face,
                   const std::array<VertexId, 3>& triangle, const Vec3& weights, const Vec3& to) {
    constexpr double least_weight = 0.01;
    const Vec3 inner = weights.cwiseMax(least_weight) / weights.cwiseMax(least_weight).sum();
    Vec3 from = Vec3::Zero();
    for (int k = 0; k < 3; ++k)
        from += inner[k] * positions[triangle[static_cast<std::size_t>(k)].index()];
    FaceId entered = face;
    for (std::size_t i = 0; i < most_elements; ++i) {
        const auto exit = exit_of(mesh, positions, entered, from, to - from);
        if (!exit)
            return !is_on_surface(mesh, positions, entered.cell, to,
                                  on_surface * (to - from).norm());
        entered = mesh.neighbor(*exit);
        if (!entered.is_valid()) return false;
    }
    return false;
}

}  // namespace incise::contact
