// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/carver.h"

#include <algorithm>
#include <cmath>

#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

namespace {

/// Returns the squared distance of two segments p0p1 and q0q1. Either may be a point.
double squared_distance(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
    const Vec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), uw = u.dot(w), vw = v.dot(w);
    const auto clamp = [](double s) { return std::clamp(s, 0.0, 1.0); };
    // First the nearest points of the lines, then each parameter again for the clamped other one.
    const double det = uu * vv - uv * uv;
    double s = det > 0.0 ? clamp((uv * vw - vv * uw) / det) : 0.0;
    const double t = vv > 0.0 ? clamp((uv * s + vw) / vv) : 0.0;
    s = uu > 0.0 ? clamp((uv * t - uw) / uu) : 0.0;
    return (w + s * u - t * v).squaredNorm();
}

struct Meets {
    const Vec3 &a, &b;

    bool operator()(const Sphere& sphere) const {
        return squared_distance(a, b, Vec3::Zero(), Vec3::Zero()) <= sphere.radius * sphere.radius;
    }
    bool operator()(const Capsule& capsule) const {
        return squared_distance(a, b, capsule.from, capsule.to) <= capsule.radius * capsule.radius;
    }
    bool operator()(const Cuboid& cuboid) const {
        double enter = 0.0, leave = 1.0;
        for (int c = 0; c < 3; ++c) {
            const double half = 0.5 * cuboid.size[c], d = b[c] - a[c];
            if (d == 0.0) {
                if (std::abs(a[c]) > half) return false;
                continue;
            }
            const double at_low = (-half - a[c]) / d, at_high = (half - a[c]) / d;
            enter = std::max(enter, std::min(at_low, at_high));
            leave = std::min(leave, std::max(at_low, at_high));
        }
        return enter <= leave;
    }
};

/// Returns the distance of the farthest point of the shape from the origin of the tool.
double reach(const CarverShape& shape) {
    if (const auto* sphere = std::get_if<Sphere>(&shape)) return sphere->radius;
    if (const auto* cuboid = std::get_if<Cuboid>(&shape)) return 0.5 * cuboid->size.norm();
    const auto& capsule = std::get<Capsule>(shape);
    return std::max(capsule.from.norm(), capsule.to.norm()) + capsule.radius;
}

}  // namespace

bool meets(const CarverShape& shape, const Vec3& a, const Vec3& b) {
    return std::visit(Meets{a, b}, shape);
}

std::vector<CellId> covered_elements(const TissueMotion& tissue, const CarverShape& shape,
                                     const Pose& before, const Pose& after) {
    Box swept(before.position);
    swept.extend(after.position);
    const Vec3 margin = Vec3::Constant(reach(shape));
    swept = Box(swept.min() - margin, swept.max() + margin);

    std::vector<CellId> covered;
    const auto may_meet = [&](const Box& box) { return swept.intersects(box); };
    tissue.for_each_near(may_meet, [&](CellId e) {
        const Vec3 from = before.to_tool(TissueMotion::centre(tissue.mesh, e, tissue.before));
        const Vec3 to = after.to_tool(TissueMotion::centre(tissue.mesh, e, tissue.after));
        if (meets(shape, from, to)) covered.push_back(e);
    });
    return covered;
}

}  // namespace incise::cutting
