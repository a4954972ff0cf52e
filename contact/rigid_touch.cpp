// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/contact/rigid_touch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "incise/topology/geometry.h"

namespace incise::contact {

// Source: Ericson 2005, Real-Time Collision Detection, closest point on a triangle by regions.
Vec3 closest_weights(const std::array<Vec3, 3>& x, const Vec3& p) {
    const Vec3 ab = x[1] - x[0], ac = x[2] - x[0], ap = p - x[0], bp = p - x[1], cp = p - x[2];
    const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp),
                 d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d1 <= 0.0 && d2 <= 0.0) return {1.0, 0.0, 0.0};
    if (d3 >= 0.0 && d4 <= d3) return {0.0, 1.0, 0.0};
    if (d6 >= 0.0 && d5 <= d6) return {0.0, 0.0, 1.0};
    const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
        const double t = d1 / (d1 - d3);
        return {1.0 - t, t, 0.0};
    }
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
        const double t = d2 / (d2 - d6);
        return {1.0 - t, 0.0, t};
    }
    if (va <= 0.0 && d4 >= d3 && d5 >= d6) {
        const double t = (d4 - d3) / (d4 - d3 + d5 - d6);
        return {0.0, 1.0 - t, t};
    }
    const double sum = va + vb + vc;
    return {1.0 - (vb + vc) / sum, vb / sum, vc / sum};
}

std::array<double, 2> closest_of_segments(const Vec3& p, const Vec3& q, const Vec3& a,
                                          const Vec3& b) {
    const Vec3 u = q - p, v = b - a, w = p - a;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w),
                 vw = v.dot(w);
    const auto unit = [](double t) { return std::clamp(t, 0.0, 1.0); };
    if (uu == 0.0) return {0.0, vv == 0.0 ? 0.0 : unit(vw / vv)};
    const double determinant = uu * vv - uv * uv;
    double s = determinant > 1e-14 * uu * vv ? unit((uv * vw - vv * uw) / determinant) : 0.5;
    const double t = vv == 0.0 ? 0.0 : unit((uv * s + vw) / vv);
    s = unit((uv * t - uw) / uu);
    return {s, t};
}

namespace {

using cutting::Capsule;
using cutting::HalfSpace;
using cutting::Sphere;
using Corners = std::array<Vec3, 3>;

constexpr double infinity = std::numeric_limits<double>::infinity();

Vec3 point_of(const Corners& x, const Vec3& weights) {
    return weights[0] * x[0] + weights[1] * x[1] + weights[2] * x[2];
}

/// Returns the part of the way from p to q at which the segment is closest to a triangle.
double closest_on_segment(const Vec3& p, const Vec3& q, const Corners& x) {
    const Vec3 area = (x[1] - x[0]).cross(x[2] - x[0]);
    const double above_p = area.dot(p - x[0]), above_q = area.dot(q - x[0]);
    double best = 0.0, least = infinity;
    const auto look = [&](double s) {
        const Vec3 at = p + s * (q - p);
        const double square = (at - point_of(x, closest_weights(x, at))).squaredNorm();
        if (square >= least) return;
        least = square;
        best = s;
    };
    // A segment that is parallel to the triangle is closest with all that is over it: then the
    // middle of its ends and of its passages over the edges counts.
    double sum = 0.0;
    if (std::abs(above_p - above_q) > 1e-9 * (std::abs(above_p) + std::abs(above_q))) {
        look(above_p < above_q ? 0.0 : 1.0);
        if ((above_p < 0.0) != (above_q < 0.0)) look(above_p / (above_p - above_q));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const double s = closest_of_segments(p, q, x[k], x[(k + 1) % 3])[0];
        sum += s;
        look(s);
    }
    look(sum / 3.0);
    look(0.0);
    look(1.0);
    return best;
}

std::optional<RigidTouch> touch_of_ball(const Vec3& centre, double radius, const Corners& x,
                                        double farthest) {
    const Vec3 area = topology::doubled_area(x[0], x[1], x[2]);
    if (!(area.squaredNorm() > 0.0)) return std::nullopt;
    const Vec3 outward = area.normalized();
    RigidTouch touch;
    touch.weights = closest_weights(x, centre);
    touch.point = point_of(x, touch.weights);
    const Vec3 away = touch.point - centre;
    const double distance = away.norm();
    if (away.dot(outward) < 0.0) {  // the centre is outside the tissue
        touch.normal = away / distance;
        touch.gap = distance - radius;
    } else {
        touch.normal = -outward;
        touch.gap = -away.dot(outward) - radius;
        // Beside the triangle, others decide. Deeper in, nothing tells where it is outside.
        if (distance > away.dot(outward) * (1.0 + 1e-6) + 1e-12 * radius || distance > radius)
            return std::nullopt;
    }
    if (touch.gap > farthest) return std::nullopt;
    return touch;
}

}  // namespace

void append_touches(const cutting::ProbeShape& shape, const Corners& corners, double farthest,
                    std::vector<RigidTouch>& touches) {
    const auto append_of_ball = [&](const Vec3& centre, double radius) {
        if (const auto touch = touch_of_ball(centre, radius, corners, farthest))
            touches.push_back(*touch);
    };
    if (const auto* ball = std::get_if<Sphere>(&shape)) {
        append_of_ball(Vec3::Zero(), ball->radius);
    } else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
        const double s = closest_on_segment(capsule->from, capsule->to, corners);
        append_of_ball(capsule->from + s * (capsule->to - capsule->from), capsule->radius);
    } else {
        const auto& half_space = std::get<HalfSpace>(shape);
        for (int k = 0; k < 3; ++k) {
            const Vec3& x = corners[static_cast<std::size_t>(k)];
            const double gap = half_space.normal.dot(x - half_space.point);
            if (gap <= farthest) touches.push_back({Vec3::Unit(k), x, half_space.normal, gap});
        }
    }
}

}  // namespace incise::contact
