// SPDX-License-Identifier: LGPL-3.0-or-later
#include "sim/tool.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "cutting/carver.h"
#include "cutting/cut_plan.h"
#include "cutting/plane.h"
#include "cutting/separator.h"
#include "cutting/surface_check.h"
#include "cutting/swept_edge.h"
#include "cutting/triangle_surface.h"
#include "cutting/undividable.h"
#include "io/surface_reader.h"
#include "topology/error.h"

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

/// Points in the tool's frame and a distance from them, so that the tool is within that distance of
/// their hull.
struct Extent {
    std::vector<Vec3> points;
    double reach = 0.0;
};

Extent extent_of(const Carver& carver) {
    if (const auto* sphere = std::get_if<SphereShape>(&carver.shape))
        return {{Vec3::Zero()}, sphere->radius};
    if (const auto* capsule = std::get_if<CapsuleShape>(&carver.shape))
        return {{capsule->from, capsule->to}, capsule->radius};
    Extent extent;
    const Vec3 half = 0.5 * std::get<BoxShape>(carver.shape).size;
    for (const double x : {-half.x(), half.x()})
        for (const double y : {-half.y(), half.y()})
            for (const double z : {-half.z(), half.z()}) extent.points.emplace_back(x, y, z);
    return extent;
}

std::shared_ptr<const cutting::CutSurface> load_surface(const Cut& cut,
                                                        std::vector<std::string>& warnings) {
    if (const auto* plane = std::get_if<PlaneSpec>(&cut.along))
        return std::make_shared<cutting::Plane>(plane->point, plane->normal);
    const auto& path = std::get<std::filesystem::path>(cut.along);
    io::SurfaceFile file = io::read_surface(path);
    for (const auto& defect : cutting::defects_of_sheet(file.surface))
        file.warnings.push_back(defect);
    for (const auto& warning : file.warnings) warnings.push_back(path.string() + ": " + warning);
    for (Vec3& x : file.surface.points) x *= cut.scale;
    return std::make_shared<cutting::TriangleSurface>(file.surface);
}

double snap_of(const ToolSpec& spec) {
    std::optional<double> snap;
    if (const auto* blade = std::get_if<Blade>(&spec.kind)) snap = blade->snap;
    if (const auto* cut = std::get_if<Cut>(&spec.kind)) snap = cut->snap;
    return snap.value_or(cutting::default_snap);
}

/// Carries the plan out. Faces of removed elements are not counted as opened.
cutting::Split carry_out(const cutting::CutPlan& plan, topology::Mesh& mesh) {
    if (plan.is_empty()) return {};
    cutting::Split done{cutting::execute(plan, mesh), {}};
    for (const topology::FacePair& pair : done.changes.faces_opened) {
        if (!mesh.is_alive(pair.a.element) || !mesh.is_alive(pair.b.element)) continue;
        ++done.report.faces_opened;
        done.report.cut_area += topology::rest_area(mesh, pair.a);
    }
    return done;
}

}  // namespace

CutMode usual_mode(const topology::Mesh& mesh) {
    for (const topology::ElementId e : mesh.elements())
        if (mesh.kind(e) != topology::CellKind::tetrahedron) return CutMode::separate;
    return CutMode::split;
}

ToolSpec with_mode(ToolSpec spec, const topology::Mesh& mesh) {
    auto* blade = std::get_if<Blade>(&spec.kind);
    if (blade && !blade->mode) blade->mode = usual_mode(mesh);
    const bool splits =
        blade ? blade->mode == CutMode::split : std::holds_alternative<Cut>(spec.kind);
    if (!splits) return spec;
    for (const topology::ElementId e : mesh.elements())
        if (mesh.kind(e) == topology::CellKind::tetrahedron) return spec;
    throw InputError("tool '" + spec.name +
                     "' splits tetrahedra, and the mesh has none; use a blade with mode = "
                     "\"separate\", which opens the faces nearest to it");
}

Tool::Tool(const ToolSpec& spec, std::vector<std::string>& warnings)
    : spec_(spec), options_{snap_of(spec), {}} {
    if (const auto* cut = std::get_if<Cut>(&spec.kind)) surface_ = load_surface(*cut, warnings);
}

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

void Tool::require_divisible(const topology::Mesh& mesh, double end_time) const {
    for_each_surface(end_time, [&](const cutting::CutSurface& surface) {
        const auto e = cutting::first_undividable(mesh, surface);
        if (!e) return;
        try {
            cutting::refuse_to_divide(mesh, *e);
        } catch (const cutting::UndividableElement& error) {
            throw InputError("tool '" + spec_.name + "' meets what it cannot divide: " +
                             error.what() + "; " + instead_of_dividing());
        }
    });
}

std::optional<std::string> Tool::warning_of_near_misses(const topology::Mesh& mesh,
                                                        double end_time) const {
    constexpr double margin = 0.05;  // of an element's mean edge: it takes little motion
    cutting::NearMisses found;
    for_each_surface(end_time, [&](const cutting::CutSurface& surface) {
        cutting::add_near_misses(mesh, surface, margin, found);
    });
    if (found.is_empty()) return std::nullopt;
    std::ostringstream text;
    text.precision(3);
    text << "tool '" << spec_.name << "' passes ";
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
         << instead_of_dividing();
    return text.str();
}

/// Calls look(surface) for each surface that the tool divides elements along up to `end_time`, s.
void Tool::for_each_surface(double end_time,
                            const std::function<void(const cutting::CutSurface&)>& look) const {
    if (spec_.path.empty() || spec_.path.front().time > end_time) return;
    if (!divides()) return;
    if (surface_) return look(*surface_);
    const auto& blade = std::get<Blade>(spec_.kind);
    // Between keys that turn the edge, its points go on arcs: in short pieces.
    constexpr double longest_turn = 0.05;
    for (std::size_t key = 1; key < spec_.path.size(); ++key) {
        const auto &from = spec_.path[key - 1], &to = spec_.path[key];
        if (from.time >= end_time) return;
        const double turn = rigid(from.value).rotation.angularDistance(rigid(to.value).rotation);
        const int num_parts = std::max(1, static_cast<int>(std::ceil(turn / longest_turn)));
        const auto time = [&](int part) {
            const double at =
                part == num_parts ? to.time : from.time + part * (to.time - from.time) / num_parts;
            return std::min(at, end_time);
        };
        for (int part = 0; part < num_parts; ++part)
            look(cutting::SweptEdge(edge_at(blade, time(part)), edge_at(blade, time(part + 1))));
    }
}

std::string Tool::instead_of_dividing() const {
    if (surface_)
        return "use a blade with mode = \"separate\", which opens the faces nearest to it, or keep "
               "the cut to tetrahedra";
    return "use mode = \"separate\", which opens the faces nearest to it";
}

bool Tool::divides() const {
    const auto* blade = std::get_if<Blade>(&spec_.kind);
    return surface_ || (blade && blade->mode == CutMode::split);
}

std::string Tool::for_longer_steps() const {
    if (divides()) return "use a larger tool.snap";
    const std::string extent = std::holds_alternative<Carver>(spec_.kind) ? "shape" : "edge";
    return "change tool." + extent +
           " or tool.path, so that it takes those as well or leaves "
           "them more of what they hang on";
}

bool Tool::is_present(double from, double to) const {
    const double first = spec_.path.front().time, last = spec_.path.back().time;
    if (first == last) return first <= to && (from < first || (from == 0.0 && first == 0.0));
    return to > first && from < last;
}

bool Tool::may_meet(const cutting::Box& box) const {
    if (surface_) return surface_->may_meet(box);
    Extent extent;
    if (const auto* carver = std::get_if<Carver>(&spec_.kind)) extent = extent_of(*carver);
    if (const auto* blade = std::get_if<Blade>(&spec_.kind)) extent.points = blade->edge;
    const cutting::Box swept = swept_box(extent.points);
    // With room for what rounding takes.
    const Vec3 reach = Vec3::Constant(extent.reach + 1e-12 * swept.diagonal().norm());
    return box.intersects(cutting::Box(swept.min() - reach, swept.max() + reach));
}

/// Holds the points of the tool's frame all along the path. A point at the distance r from the
/// frame's origin that turns by an angle leaves the straight way between its ends by at most
/// r angle^2 / 8: its acceleration over a path of length 1 is r angle^2.
cutting::Box Tool::swept_box(std::span<const Vec3> points) const {
    cutting::Box swept;
    cutting::Pose before = rigid(spec_.path.front().value);
    for (const auto& key : spec_.path) {
        const cutting::Pose after = rigid(key.value);
        const double angle = before.rotation.angularDistance(after.rotation);
        for (const Vec3& x : points) {
            cutting::Box way(before.to_world(x));
            way.extend(after.to_world(x));
            const Vec3 bulge = Vec3::Constant(x.norm() * angle * angle / 8.0);
            swept.extend(cutting::Box(way.min() - bulge, way.max() + bulge));
        }
        before = after;
    }
    return swept;
}

cutting::Split Tool::cut(topology::Mesh& mesh, const cutting::TissueMotion& tissue,
                         cutting::Scars& scars, std::span<cutting::RestingBlade> resting,
                         double from, double to) {
    if (!is_present(from, to)) return {};
    return std::visit(
        [&](const auto& kind) { return cut_with(kind, mesh, tissue, scars, resting, from, to); },
        spec_.kind);
}

bool Tool::is_to_finish(double from, double to) const {
    return !front_.is_empty() && is_present(from, to) && to >= spec_.path.back().time;
}

cutting::Split Tool::finish(topology::Mesh& mesh, const cutting::TissueMotion& tissue,
                            cutting::Scars& scars, std::span<cutting::RestingBlade> resting) {
    const auto& blade = std::get<Blade>(spec_.kind);
    const std::vector<Vec3> there = edge_at(blade, spec_.path.back().time);
    // It may have rested before the end. The way between two keys is curved if it turns: a short
    // part of it before its end tells the direction.
    constexpr double part = 1e-3;
    std::vector<Vec3> motion(there.size(), Vec3::Zero());
    for (std::size_t key = spec_.path.size() - 1; key > 0; --key) {
        const auto &before = spec_.path[key - 1], &after = spec_.path[key];
        const cutting::Pose a = rigid(before.value), b = rigid(after.value);
        if (a.position == b.position && a.rotation.coeffs() == b.rotation.coeffs()) continue;
        const auto there_before = edge_at(blade, after.time - part * (after.time - before.time));
        for (std::size_t i = 0; i < motion.size(); ++i)
            motion[i] = b.to_world(blade.edge[i]) - there_before[i];
        break;
    }
    return cutting::finish(mesh, tissue, {there, motion}, front_, options_, scars, resting);
}

std::optional<cutting::RestingBlade> Tool::resting(double from, double to, bool has_moved) {
    if (front_.is_empty()) return std::nullopt;
    const auto edge = edge_at(std::get<Blade>(spec_.kind), has_moved ? to : from);
    return cutting::RestingBlade{front_, {edge, edge}, has_moved, options_.snap > 0.0};
}

cutting::Split Tool::cut_with(const Carver& carver, topology::Mesh& mesh,
                              const cutting::TissueMotion& tissue, cutting::Scars&,
                              std::span<cutting::RestingBlade>, double from, double to) {
    cutting::CutPlan plan;
    plan.elements_to_remove =
        cutting::covered_elements(tissue, rigid(carver), pose(from), pose(to));
    return carry_out(plan, mesh);
}

std::vector<Vec3> Tool::edge_at(const Blade& blade, double time) const {
    const cutting::Pose at = pose(time);
    std::vector<Vec3> edge;
    for (const Vec3& x : blade.edge) edge.push_back(at.to_world(x));
    return edge;
}

cutting::Box Tool::box_at(const Blade& blade, double time) const {
    const cutting::Pose at = pose(time);
    cutting::Box box;
    for (const Vec3& x : blade.edge) box.extend(at.to_world(x));
    return box;
}

cutting::Split Tool::cut_with(const Blade& blade, topology::Mesh& mesh,
                              const cutting::TissueMotion& tissue, cutting::Scars& scars,
                              std::span<cutting::RestingBlade> resting, double from, double to) {
    if (front_.is_empty() && !tissue.may_meet(box_at(blade, from).merged(box_at(blade, to))))
        return {};
    const auto before = edge_at(blade, from), after = edge_at(blade, to);
    if (blade.mode == CutMode::split)
        return cutting::split(mesh, tissue, cutting::SweptEdge(before, after), front_, options_,
                              scars, resting);
    cutting::CutPlan plan;
    plan.faces_to_open = cutting::faces_to_open(tissue, before, after);
    return carry_out(plan, mesh);
}

cutting::Split Tool::cut_with(const Cut&, topology::Mesh& mesh, const cutting::TissueMotion& tissue,
                              cutting::Scars& scars, std::span<cutting::RestingBlade> resting,
                              double, double) {
    cutting::CutFront front;
    return cutting::split(mesh, tissue, *surface_, front, options_, scars, resting);
}

}  // namespace incise::sim
