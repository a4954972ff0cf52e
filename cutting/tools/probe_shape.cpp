// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/probe_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

#include "incise/cutting/tools/solid.h"

namespace incise::cutting {

Box box_of(const ProbeShape& shape) {
    if (const auto* ball = std::get_if<Sphere>(&shape))
        return {Vec3::Constant(-ball->radius), Vec3::Constant(ball->radius)};
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
        const Vec3 radius = Vec3::Constant(capsule->radius);
        return {capsule->from.cwiseMin(capsule->to) - radius,
                capsule->from.cwiseMax(capsule->to) + radius};
    }
    if (const auto* box = std::get_if<Cuboid>(&shape)) return {-0.5 * box->size, 0.5 * box->size};
    if (const auto* solid = std::get_if<Solid>(&shape)) {
        Box round;
        for (const Vec3& x : solid->surface.points) round.extend(x);
        return round;
    }
    return {Vec3::Constant(-std::numeric_limits<double>::infinity()),
            Vec3::Constant(std::numeric_limits<double>::infinity())};
}

double half_width_of(const ProbeShape& shape) {
    if (const auto* ball = std::get_if<Sphere>(&shape)) return ball->radius;
    if (const auto* capsule = std::get_if<Capsule>(&shape)) return capsule->radius;
    if (const auto* box = std::get_if<Cuboid>(&shape)) return 0.5 * box->size.minCoeff();
    if (const auto* solid = std::get_if<Solid>(&shape)) {
        // Half the thickness of a plate; a third of the radius of a ball.
        double area = 0.0;
        const auto at = [&](std::int64_t p) -> const Vec3& {
            return solid->surface.points[static_cast<std::size_t>(p)];
        };
        for (const auto& [a, b, c] : solid->surface.triangles)
            area += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
        return volume_of(solid->surface) / area;
    }
    return std::numeric_limits<double>::infinity();
}

double reach_of(const ProbeShape& shape) {
    if (const auto* ball = std::get_if<Sphere>(&shape)) return ball->radius;
    if (const auto* capsule = std::get_if<Capsule>(&shape))
        return std::max(capsule->from.norm(), capsule->to.norm()) + capsule->radius;
    if (const auto* box = std::get_if<Cuboid>(&shape)) return 0.5 * box->size.norm();
    if (const auto* solid = std::get_if<Solid>(&shape)) {
        double square = 0.0;
        for (const Vec3& x : solid->surface.points) square = std::max(square, x.squaredNorm());
        return std::sqrt(square);
    }
    return 0.0;
}

bool is_inside(const ProbeShape& shape, const Vec3& x) {
    if (const auto* half_space = std::get_if<HalfSpace>(&shape))
        return half_space->normal.dot(x - half_space->point) < 0.0;
    if (const auto* ball = std::get_if<Sphere>(&shape)) return meets(*ball, x, x);
    if (const auto* capsule = std::get_if<Capsule>(&shape)) return meets(*capsule, x, x);
    if (const auto* box = std::get_if<Cuboid>(&shape)) return meets(*box, x, x);
    return encloses(std::get<Solid>(shape).surface, x);
}

}  // namespace incise::cutting
