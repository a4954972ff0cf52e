// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tool_build.h"

#include <algorithm>
#include <functional>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/cutting/exact/undividable.h"
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

ToolSpec with_mode(ToolSpec spec, const topology::Mesh& mesh) {
    // A tool of an unknown kind has been read as several kinds.
    if (auto* blade = std::get_if<cutting::Blade>(&spec.shape); blade && spec.has_usual_mode) {
        blade->mode = cutting::usual_mode(mesh);
        spec.has_usual_mode = false;
        // A mode that was chosen has been judged before.
        if (blade->toughness > 0.0 && blade->mode == CutMode::separate)
            throw InputError("tool '" + spec.name +
                             "' has a toughness, and the mesh has elements that are no tetrahedra: "
                             "where it opens faces, its force is not known; leave toughness out");
    }
    if (!divides(spec.shape)) return spec;
    for (const CellId e : mesh.elements())
        if (mesh.kind(e) == topology::CellKind::tetrahedron) return spec;
    throw InputError("tool '" + spec.name +
                     "' splits tetrahedra, and the mesh has none; use a blade with mode = "
                     "\"separate\", which opens the faces nearest to it");
}

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

namespace {

/// Calls look(surface) for each surface along which the tool divides elements until `end_time`, s.
void for_each_surface(const ScriptedTool& tool, double end_time,
                      const std::function<void(const cutting::CutSurface&)>& look) {
    const auto& keys = tool.path.keys();
    if (keys.empty() || keys.front().time > end_time || !divides(tool.shape)) return;
    if (tool.surface) return look(*tool.surface);
    const std::vector<std::vector<Vec3>> edges = kind_of(tool.shape).edges(tool, end_time);
    for (std::size_t i = 1; i < edges.size(); ++i) look(cutting::SweptEdge(edges[i - 1], edges[i]));
}

}  // namespace

void require_divisible(const ScriptedTool& tool, const topology::Mesh& mesh, double end_time) {
    for_each_surface(tool, end_time, [&](const cutting::CutSurface& surface) {
        const auto e = cutting::first_undividable(mesh, surface);
        if (!e) return;
        try {
            cutting::refuse_to_divide(mesh, *e);
        } catch (const cutting::UndividableElement& error) {
            throw InputError("tool '" + tool.name + "' meets what it cannot divide: " +
                             error.what() + "; " + instead_of_dividing(tool.shape));
        }
    });
}

std::optional<std::string> warning_of_near_misses(const ScriptedTool& tool,
                                                  const topology::Mesh& mesh, double end_time) {
    constexpr double margin = 0.05;  // share of the mean edge of an element; a small distance
    cutting::NearMisses found;
    for_each_surface(tool, end_time, [&](const cutting::CutSurface& surface) {
        cutting::add_near_misses(mesh, surface, margin, found);
    });
    if (found.is_empty()) return std::nullopt;
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << tool.name << "' passes ";
    if (found.distance > 0.0)
        text << "only " << found.distance << " m from";
    else
        text << "along a side of";
    text << " element " << mesh.label(found.nearest) << ", a "
         << topology::traits(mesh.kind(found.nearest)).name
         << " that it cannot divide, where the body rests";
    const std::size_t num_others = found.elements.size() - 1;
    if (num_others > 0)
        text << " (and near " << num_others << (num_others == 1 ? " other)" : " others)");
    text << ": the run stops if the tissue moves into it; keep it farther from there, or "
         << instead_of_dividing(tool.shape);
    return text.str();
}

std::string instead_of_dividing(const cutting::ToolShape& shape) {
    if (std::holds_alternative<cutting::Blade>(shape))
        return "use mode = \"separate\", which opens the faces nearest to it";
    return "use a blade with mode = \"separate\", which opens the faces nearest to it, or keep "
           "the cut to tetrahedra";
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
