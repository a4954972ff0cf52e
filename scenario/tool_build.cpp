// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tool_build.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/cutting/exact/undividable.h"
#include "incise/cutting/surfaces/surface_check.h"
#include "incise/cutting/surfaces/swept_edge.h"
#include "incise/cutting/tools/probe_shape.h"
#include "incise/cutting/tools/solid.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/topology/cell_point.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::scenario {

namespace {

/// The extent of a tool: the tool is within `radius` of the convex hull of `points`, in the frame
/// of the tool.
struct Extent {
    std::vector<Vec3> points;
    double radius = 0.0;
};

/// @param shape  none that is unbounded
Extent extent_of(const auto& shape) {
    if (const auto* sphere = std::get_if<cutting::Sphere>(&shape))
        return {{Vec3::Zero()}, sphere->radius};
    if (const auto* capsule = std::get_if<cutting::Capsule>(&shape))
        return {{capsule->from, capsule->to}, capsule->radius};
    Extent extent;
    if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, cutting::ProbeShape>)
        if (const auto* solid = std::get_if<cutting::Solid>(&shape))
            return {solid->surface.points, 0.0};
    const auto* box = std::get_if<cutting::Cuboid>(&shape);
    const Vec3 half = box ? Vec3(0.5 * box->size) : Vec3(Vec3::Zero());
    for (const double x : {-half.x(), half.x()})
        for (const double y : {-half.y(), half.y()})
            for (const double z : {-half.z(), half.z()}) extent.points.emplace_back(x, y, z);
    return extent;
}

Extent extent_of_tool(const cutting::ToolShape& shape) {
    if (const auto* carver = std::get_if<Carver>(&shape)) return extent_of(carver->shape);
    if (const auto* probe = std::get_if<cutting::Probe>(&shape)) return extent_of(probe->shape);
    if (const auto* grasper = std::get_if<cutting::Grasper>(&shape))
        return extent_of(grasper->jaws);
    return {std::get<cutting::Blade>(shape).edge};
}

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

cutting::ToolShape shape_of(const BladeSpec& blade) {
    return cutting::Blade{blade.edge, blade.mode.value_or(CutMode::split),
                          blade.snap.value_or(cutting::default_snap), blade.toughness,
                          blade.cutting_force};
}

cutting::ToolShape shape_of(const ProbeSpec& spec, std::vector<std::string>& warnings) {
    if (spec.surface.empty()) return spec.probe;
    io::SurfaceFile file = io::read_surface(spec.surface);
    for (Vec3& x : file.surface.points) x *= spec.scale;
    bool was_turned = false;
    cutting::Solid solid = cutting::make_solid(file.surface, was_turned);
    if (was_turned) file.warnings.push_back("its triangles face inwards, and are turned");
    if (const std::string fault = cutting::fault_of(solid); !fault.empty())
        throw InputError(spec.surface.string() + ": " + fault);
    for (const auto& warning : file.warnings)
        warnings.push_back(spec.surface.string() + ": " + warning);
    return cutting::Probe{std::move(solid), spec.probe.friction};
}

cutting::ToolShape shape_of(const CutSpec& cut, std::vector<std::string>& warnings) {
    const double snap = cut.snap.value_or(cutting::default_snap);
    if (const auto* plane = std::get_if<PlaneSpec>(&cut.along))
        return cutting::PlaneCut{plane->point, plane->normal, snap};
    const auto& path = std::get<std::filesystem::path>(cut.along);
    io::SurfaceFile file = io::read_surface(path);
    for (const auto& defect : cutting::defects_of_surface(file.surface))
        file.warnings.push_back(defect);
    for (const auto& warning : file.warnings) warnings.push_back(path.string() + ": " + warning);
    for (Vec3& x : file.surface.points) x *= cut.scale;
    return cutting::SurfaceCut{std::move(file.surface), snap};
}

}  // namespace

CutMode usual_mode(const topology::Mesh& mesh) {
    for (const CellId e : mesh.elements())
        if (mesh.kind(e) != topology::CellKind::tetrahedron) return CutMode::separate;
    return CutMode::split;
}

ToolSpec with_mode(ToolSpec spec, const topology::Mesh& mesh) {
    auto* blade = std::get_if<BladeSpec>(&spec.kind);
    const bool is_usual = blade && !blade->mode;
    if (is_usual) blade->mode = usual_mode(mesh);
    // A mode that was chosen has been judged before.
    if (is_usual && blade->toughness > 0.0 && blade->mode == CutMode::separate)
        throw InputError("tool '" + spec.name +
                         "' has a toughness, and the mesh has elements that are no tetrahedra: "
                         "where it opens faces, its force is not known; leave toughness out");
    const bool splits =
        blade ? blade->mode == CutMode::split : std::holds_alternative<CutSpec>(spec.kind);
    if (!splits) return spec;
    for (const CellId e : mesh.elements())
        if (mesh.kind(e) == topology::CellKind::tetrahedron) return spec;
    throw InputError("tool '" + spec.name +
                     "' splits tetrahedra, and the mesh has none; use a blade with mode = "
                     "\"separate\", which opens the faces nearest to it");
}

ScriptedTool build_tool(const ToolSpec& spec, std::vector<std::string>& warnings) {
    cutting::ToolShape shape;
    if (const auto* carver = std::get_if<Carver>(&spec.kind)) shape = *carver;
    if (const auto* blade = std::get_if<BladeSpec>(&spec.kind)) shape = shape_of(*blade);
    if (const auto* cut = std::get_if<CutSpec>(&spec.kind)) shape = shape_of(*cut, warnings);
    if (const auto* probe = std::get_if<ProbeSpec>(&spec.kind)) shape = shape_of(*probe, warnings);
    const auto* grasper = std::get_if<GrasperSpec>(&spec.kind);
    if (grasper) shape = grasper->grasper;
    const auto* suture = std::get_if<SutureSpec>(&spec.kind);
    if (suture) shape = suture->suture;
    auto surface = cutting::cut_surface_of(shape);
    ScriptedTool tool{spec.name, std::move(shape), ToolPath(spec.path, spec.is_obstacle),
                      std::move(surface)};
    if (grasper) {
        tool.close = grasper->close;
        tool.open = grasper->open;
    }
    if (suture) {
        tool.over = suture->over;
        tool.length = suture->length;
    }
    return tool;
}

void require_tissue(const ScriptedTool& tool, const topology::Mesh& mesh) {
    const auto* suture = std::get_if<cutting::Suture>(&tool.shape);
    if (!suture) return;
    const double reach = suture->reach > 0.0 ? suture->reach : topology::mean_element_length(mesh);
    for (std::size_t i = 0; i < suture->points.size(); ++i) {
        const Vec3& x = suture->points[i];
        if (topology::find_point(mesh, mesh.rest_positions(), x, reach)) continue;
        std::ostringstream text;
        text << "tool '" << tool.name << "': point " << i << " (from 0), [" << x.x() << ", "
             << x.y() << ", " << x.z() << "], is farther than its reach, " << format_number(reach)
             << " m, from the body at rest; check its coordinates and units";
        throw InputError(text.str());
    }
}

std::optional<std::string> warning_of_tissue_inside(const ScriptedTool& tool,
                                                    const topology::Mesh& mesh) {
    const auto* probe = std::get_if<cutting::Probe>(&tool.shape);
    if (!probe || tool.path.keys().empty()) return std::nullopt;
    const Pose& pose = tool.path.keys().front().value;
    const double size = topology::mean_element_length(mesh);
    const Vec3 margin = Vec3::Constant(1e-3 * size);
    const Box box = cutting::box_of(probe->shape);
    std::size_t count = 0;
    Vec3 first = Vec3::Zero();
    for (const VertexId n : mesh.nodes()) {
        const Vec3 x = pose.to_tool(mesh.rest_position(n));
        // What lies on the surface is not inside.
        if (!Box(box.min() + margin, box.max() - margin).contains(x)) continue;
        if (!cutting::is_inside(probe->shape, x)) continue;
        if (const auto* half_space = std::get_if<cutting::HalfSpace>(&probe->shape);
            half_space && half_space->normal.dot(x - half_space->point) > -1e-3 * size)
            continue;
        if (count++ == 0) first = mesh.rest_position(n);
    }
    if (count == 0) return std::nullopt;
    std::ostringstream text;
    text << "tool '" << tool.name << "' has " << count << (count == 1 ? " point" : " points")
         << " of the body at rest inside it where its path begins, one of them at [" << first.x()
         << ", " << first.y() << ", " << first.z()
         << "]: such tissue is pushed out slowly or not at all; let the path begin outside";
    return text.str();
}

bool may_meet(const ScriptedTool& tool, const Box& box) {
    if (tool.surface) return tool.surface->may_meet(box);
    if (std::holds_alternative<cutting::Suture>(tool.shape)) return true;  // see require_tissue()
    const auto* probe = std::get_if<cutting::Probe>(&tool.shape);
    if (probe && std::holds_alternative<cutting::HalfSpace>(probe->shape)) return true;
    const Extent extent = extent_of_tool(tool.shape);
    const Box swept = swept_box(tool.path, extent.points);
    // The second term is a margin for rounding.
    const Vec3 margin = Vec3::Constant(extent.radius + 1e-12 * swept.diagonal().norm());
    return box.intersects(Box(swept.min() - margin, swept.max() + margin));
}

namespace {

/// Calls look(surface) for each surface along which the tool divides elements until `end_time`, s.
void for_each_surface(const ScriptedTool& tool, double end_time,
                      const std::function<void(const cutting::CutSurface&)>& look) {
    const auto& keys = tool.path.keys();
    if (keys.empty() || keys.front().time > end_time || !divides(tool.shape)) return;
    if (tool.surface) return look(*tool.surface);
    const auto& blade = std::get<cutting::Blade>(tool.shape);
    // Where the edge turns, its points move on arcs. Short parts approximate these.
    constexpr double longest_turn = 0.05;
    for (std::size_t key = 1; key < keys.size(); ++key) {
        const auto &from = keys[key - 1], &to = keys[key];
        if (from.time >= end_time) return;
        const double turn = from.value.rotation.angularDistance(to.value.rotation);
        const int num_parts = std::max(1, static_cast<int>(std::ceil(turn / longest_turn)));
        const auto edge = [&](int part) {
            const double at =
                part == num_parts ? to.time : from.time + part * (to.time - from.time) / num_parts;
            std::vector<Vec3> points;
            cutting::place_edge(blade, tool.path.pose(std::min(at, end_time)), points);
            return points;
        };
        for (int part = 0; part < num_parts; ++part)
            look(cutting::SweptEdge(edge(part), edge(part + 1)));
    }
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
    return !std::holds_alternative<Carver>(shape) && cutting::traits_of(shape).cuts;
}

std::string for_longer_steps(const cutting::ToolShape& shape) {
    if (divides(shape)) return "move the cut away from the stiffest elements";
    const std::string extent = std::holds_alternative<Carver>(shape) ? "shape" : "edge";
    return "change tool." + extent +
           " or tool.path, so that it takes those as well or leaves "
           "them more of what they hang on";
}

}  // namespace incise::scenario
