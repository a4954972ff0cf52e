// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/tools/tool.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "incise/cutting/surfaces/plane.h"
#include "incise/cutting/surfaces/triangle_surface.h"

namespace incise::cutting {

std::shared_ptr<const CutSurface> cut_surface_of(const ToolShape& shape) {
    if (const auto* plane = std::get_if<PlaneCut>(&shape))
        return std::make_shared<Plane>(plane->point, plane->normal);
    if (const auto* cut = std::get_if<SurfaceCut>(&shape))
        return std::make_shared<TriangleSurface>(cut->surface);
    return nullptr;
}

std::array<Vec3, 2> meeting_line(const Scissors& scissors, double closed) {
    // The blades never meet in the pivot itself: a line without length cuts nothing.
    constexpr double nearest = 0.02;  // of the length
    const double on_blade = scissors.length * std::lerp(nearest, 1.0, closed);
    const double across = on_blade * std::sin(0.5 * scissors.angle);
    const double along = on_blade * std::cos(0.5 * scissors.angle);
    return {Vec3(-across, 0.0, -along), Vec3(across, 0.0, -along)};
}

void place_edge(const Blade& blade, const Pose& pose, std::vector<Vec3>& edge) {
    edge.resize(blade.edge.size());
    std::ranges::transform(blade.edge, edge.begin(),
                           [&](const Vec3& x) { return pose.to_world(x); });
}

}  // namespace incise::cutting
