// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tool_build.h"

#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

namespace {

/// Returns a box that contains the points, given in the frame of the tool, along the whole path. If
/// the frame turns by an angle, a point at the distance r from its origin moves on a curve. The
/// curve leaves the straight line between its ends by at most r angle^2 / 8, because in a motion of
/// the duration 1 the acceleration is r angle^2.
Box swept_box(const ToolPath& path, std::span<const Vec3> points) {
    Box swept;
    Pose before = path.keys().front().value;
    for (const auto& [time, after] : path.keys()) {
        const double angle = before.rotation.angularDistance(after.rotation);
        for (const Vec3& x : points) {
            Box way(before.to_world(x));
            way.extend(after.to_world(x));
            const Vec3 bulge = Vec3::Constant(x.norm() * angle * angle / 8.0);
            swept.extend(Box(way.min() - bulge, way.max() + bulge));
        }
        before = after;
    }
    return swept;
}

}  // namespace

ScriptedTool build_tool(const ToolSpec& spec, std::vector<std::string>& warnings) {
    cutting::ToolShape shape = spec.shape;
    if (spec.surface) {
        const std::string file_name = spec.surface->path.string();
        io::SurfaceFile file = io::read_surface(spec.surface->path);
        try {
            kind_of(shape).take_surface(file.surface, spec.surface->scale, shape, file.warnings);
        } catch (const InputError& error) {
            throw InputError(file_name + ": " + error.what());
        }
        for (const auto& warning : file.warnings)
            warnings.emplace_back(file_name).append(": ").append(warning);
    }
    auto surface = cutting::cut_surface_of(shape);
    return {spec.name,          std::move(shape), ToolPath(spec.path, spec.is_obstacle),
            std::move(surface), spec.close,       spec.open,
            spec.over,          spec.length};
}

bool may_meet(const ScriptedTool& tool, const Box& box) {
    if (tool.surface) return tool.surface->may_meet(box);
    const auto extent = kind_of(tool.shape).extent(tool.shape);
    if (!extent) return true;
    const Box swept = swept_box(tool.path, extent->points);
    // The second term is a margin for rounding.
    const Vec3 margin = Vec3::Constant(extent->radius + 1e-12 * swept.diagonal().norm());
    return box.intersects(Box(swept.min() - margin, swept.max() + margin));
}

bool divides(const cutting::ToolShape& shape) {
    if (const auto* blade = std::get_if<cutting::Blade>(&shape))
        return blade->mode == CutMode::split;
    return !std::holds_alternative<cutting::Carver>(shape) && cutting::traits_of(shape).cuts;
}

std::string for_longer_steps(const cutting::ToolShape& shape) {
    if (divides(shape)) return "move the cut away from the stiffest elements";
    const std::string extent = std::holds_alternative<cutting::Carver>(shape) ? "shape" : "edge";
    return "change tool." + extent +
           " or tool.path, so that it takes those as well or leaves "
           "them more of what they hang on";
}

}  // namespace incise::scenario
