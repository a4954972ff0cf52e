// Shapes as functions of space, negative inside and about the distance to the surface near it, and
// their smooth blends (polynomial minimum: I. Quilez, "Smooth minimum").
// Arithmetic and square roots only, which give the same bits on every machine.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cmath>

#include "incise/base/types.h"

namespace incise::organs {

inline double ball(const Vec3& p, const Vec3& centre, double radius) {
    return (p - centre).norm() - radius;
}

/// An ellipsoid along the axes; a distance to first order only.
inline double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
    const Vec3 scaled = (p - centre).cwiseQuotient(radii);
    const double gradient = scaled.cwiseQuotient(radii).norm();
    if (gradient == 0.0) return -radii.minCoeff();
    const double level = scaled.norm();
    return level * (level - 1.0) / gradient;
}

/// All points within `radius` of a segment.
inline double capsule(const Vec3& p, const Vec3& start, const Vec3& end, double radius) {
    const Vec3 axis = end - start;
    const double along = std::clamp((p - start).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
    return (p - start - along * axis).norm() - radius;
}

/// Union of two shapes whose seam is filled where they are nearer to each other than `blend`
/// (metres, above 0); it bulges by blend / 4 at most.
inline double smooth_union(double a, double b, double blend) {
    const double overlap = std::max(blend - std::abs(a - b), 0.0) / blend;
    return std::min(a, b) - 0.25 * blend * overlap * overlap;
}

/// Intersection of two shapes whose edge is rounded over `blend`.
inline double smooth_intersection(double a, double b, double blend) {
    return -smooth_union(-a, -b, blend);
}

/// Shape `a` without shape `b`, with a rounded rim.
inline double smooth_difference(double a, double b, double blend) {
    return smooth_intersection(a, -b, blend);
}

}  // namespace incise::organs
