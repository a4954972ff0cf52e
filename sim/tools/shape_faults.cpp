// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tools/shape_faults.h"

#include <algorithm>
#include <cmath>

#include "incise/base/number_format.h"
#include "incise/cutting/tools/solid.h"

namespace incise::sim {

namespace {

std::string fault_of_length(const char* what, double length) {
    if (length > 0.0 && std::isfinite(length)) return "";
    return what + (" of " + format_number(length)) + " m: it must be above 0";
}

std::string fault_of(const cutting::HalfSpace& half_space) {
    if (!half_space.point.allFinite()) return "its point is not finite";
    if (std::abs(half_space.normal.norm() - 1.0) < 1e-6) return "";
    return "its normal has a length of " + format_number(half_space.normal.norm()) +
           ": it must be 1";
}
std::string fault_of(const cutting::Sphere& sphere) {
    return fault_of_length("it has a radius", sphere.radius);
}
std::string fault_of(const cutting::Capsule& capsule) {
    if (!capsule.from.allFinite() || !capsule.to.allFinite()) return "its axis is not finite";
    return fault_of_length("it has a radius", capsule.radius);
}
std::string fault_of(const cutting::Cuboid& cuboid) {
    if (!cuboid.size.allFinite()) return "its size is not finite";
    return fault_of_length("it has an edge", cuboid.size.minCoeff());
}

}  // namespace

std::string fault_of_snap(double snap) {
    if (snap >= 0.0 && snap <= 0.5) return "";
    return "it has a snap of " + format_number(snap) + ": it must be from 0 to 0.5";
}

std::string fault_of_line(std::span<const Vec3> points, const std::string& what,
                          const std::string& subject) {
    if (points.size() < 2)
        return subject + " needs at least 2 points, and has " + std::to_string(points.size());
    if (!std::ranges::all_of(points, [](const Vec3& x) { return x.allFinite(); }))
        return "a point of its " + what + " is not finite";
    if (std::ranges::adjacent_find(points) != points.end())
        return "two points of its " + what + " that follow each other are the same";
    return "";
}

std::string fault_of_max_force(double max_force) {
    if (max_force > 0.0) return "";
    return "its largest force is " + format_number(max_force) + " N: it must be above 0";
}

std::string fault_of_shape(const cutting::CarverShape& shape) {
    return std::visit([](const auto& one) { return fault_of(one); }, shape);
}

std::string fault_of_shape(const cutting::ProbeShape& shape) {
    return std::visit([](const auto& one) { return fault_of(one); }, shape);
}

}  // namespace incise::sim
