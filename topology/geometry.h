// Volumes and centres of cells of all kinds, from their corner positions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/cell_shape.h"

namespace incise::topology {

/// Returns the signed volume of a tetrahedron. It is positive if a, b, c run anticlockwise as seen
/// from d.
inline double tetrahedron_volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return (b - a).cross(c - a).dot(d - a) / 6.0;
}

/// Returns the volume between the origin and a face. A quadrilateral is the bilinear patch: the
/// flux of x through it is the mean of the fluxes through its two triangulations. A face of more
/// corners is the fan of its triangles about their mean, which is the same from both sides.
/// @param size  the number of corners
/// @param at    (position): the corner, anticlockwise as seen from outside
template <class CornerAt>
double flux_of_face(int size, CornerAt at) {
    const auto flux = [](const Vec3& a, const Vec3& b, const Vec3& c) {
        return a.dot(b.cross(c)) / 6.0;
    };
    const Vec3 a = at(0), b = at(1), c = at(2);
    if (size == 3) return flux(a, b, c);
    if (size == 4) {
        const Vec3 d = at(3);
        return 0.5 * (flux(a, b, c) + flux(a, c, d) + flux(a, b, d) + flux(b, c, d));
    }
    Vec3 middle = Vec3::Zero();
    for (int p = 0; p < size; ++p) middle += at(p);
    middle /= size;
    double sum = 0.0;
    for (int p = 0; p < size; ++p) sum += flux(middle, at(p), at(p + 1 == size ? 0 : p + 1));
    return sum;
}

/// Returns the signed volume of a cell with straight edges. Quadrilateral faces are the bilinear
/// patches of the trilinear map, so that cells which share such a face have no gap between them.
inline double signed_volume(CellKind kind, std::span<const Vec3> corners) {
    const Vec3& o = corners[0];
    if (kind == CellKind::tetrahedron)
        return tetrahedron_volume(o, corners[1], corners[2], corners[3]);
    const CellTraits& t = traits(kind);
    double volume = 0.0;
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        volume += flux_of_face(static_cast<int>(face.size()), [&](int p) -> Vec3 {
            return corners[static_cast<std::size_t>(face[static_cast<std::size_t>(p)])] - o;
        });
    }
    return volume;
}

/// Returns the volume of a cell of any shape.
/// @param positions  by vertex id, m
inline double volume_of(const CellShape& shape, std::span<const Vec3> positions) {
    const Vec3& o = positions[shape.face(0)[0].index()];
    double volume = 0.0;
    for (int f = 0; f < shape.num_faces(); ++f) {
        const auto face = shape.face(f);
        volume += flux_of_face(static_cast<int>(face.size()), [&](int p) -> Vec3 {
            return positions[face[static_cast<std::size_t>(p)].index()] - o;
        });
    }
    return volume;
}

/// Returns the area vector of a face, which points outwards: the sum of the fan of its triangles.
/// It is the same for all corners from which the fan begins, also if three of them are in a line.
/// @param size  the number of corners
/// @param at    (position): the corner, anticlockwise as seen from outside
template <class CornerAt>
Vec3 area_vector(int size, CornerAt at) {
    const Vec3 first = at(0);
    Vec3 sum = Vec3::Zero();
    for (int p = 2; p < size; ++p) sum += (at(p - 1) - first).cross(at(p) - first);
    return 0.5 * sum;
}

/// Returns twice the area vector of a triangle. It is exactly zero if the triangle has no area but
/// for rounding, as one between corners on a straight side of a face: then it has no direction.
inline Vec3 doubled_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double rounding = 1e-10;  // of the square of its width
    const Vec3 u = b - a, v = c - a, area = u.cross(v);
    const double least = rounding * std::max(u.squaredNorm(), v.squaredNorm());
    return area.squaredNorm() > least * least ? area : Vec3::Zero();
}

/// Returns the mean of the corners.
inline Vec3 centre(std::span<const Vec3> corners) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : corners) sum += corner;
    return sum / static_cast<double>(corners.size());
}

}  // namespace incise::topology
