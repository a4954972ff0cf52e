// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/tool.h"

#include <algorithm>

#include "cutting/carver.h"
#include "cutting/separator.h"

namespace incise::sim {

namespace {

cutting::Pose rigid(const Pose& key) {
    return {Eigen::Quaterniond(Eigen::AngleAxisd(key.angle, key.axis)), key.at};
}

cutting::CarverShape rigid(const Carver& carver) {
    if (const auto* sphere = std::get_if<SphereShape>(&carver.shape))
        return cutting::Sphere{sphere->radius};
    if (const auto* capsule = std::get_if<CapsuleShape>(&carver.shape))
        return cutting::Capsule{capsule->from, capsule->to, capsule->radius};
    return cutting::Cuboid{std::get<BoxShape>(carver.shape).size};
}

}  // namespace

cutting::Pose Tool::pose(double time) const {
    const auto after =
        std::upper_bound(spec_.path.begin(), spec_.path.end(), time,
                         [](double t, const TimeKey<Pose>& key) { return t < key.time; });
    if (after == spec_.path.begin()) return rigid(spec_.path.front().value);
    if (after == spec_.path.end()) return rigid(spec_.path.back().value);
    const auto before = after - 1;
    const double s = (time - before->time) / (after->time - before->time);
    const cutting::Pose a = rigid(before->value), b = rigid(after->value);
    return {a.rotation.slerp(s, b.rotation), a.position + s * (b.position - a.position)};
}

bool Tool::is_present(double from, double to) const {
    const double first = spec_.path.front().time, last = spec_.path.back().time;
    if (first == last) return first <= to && (from < first || (from == 0.0 && first == 0.0));
    return to > first && from < last;
}

cutting::CutPlan Tool::plan(const cutting::TissueMotion& tissue, double from, double to) const {
    cutting::CutPlan plan;
    if (!is_present(from, to)) return plan;
    const cutting::Pose before = pose(from), after = pose(to);
    if (const auto* carver = std::get_if<Carver>(&spec_.kind)) {
        plan.elements_to_remove = cutting::covered_elements(tissue, rigid(*carver), before, after);
    } else {
        const auto& edge = std::get<Blade>(spec_.kind).edge;
        std::vector<Vec3> edge_before, edge_after;
        for (const Vec3& x : edge) {
            edge_before.push_back(before.to_world(x));
            edge_after.push_back(after.to_world(x));
        }
        plan.faces_to_open = cutting::faces_to_open(tissue, edge_before, edge_after);
    }
    return plan;
}

}  // namespace incise::sim
