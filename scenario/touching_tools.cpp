// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/touching_tools.h"

#include <string>

#include "incise/base/number_format.h"
#include "incise/scenario/scenario_sections.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys shape_keys[] = {"sphere", "capsule", "box"};
constexpr Keys probe_shape_keys[] = {"sphere", "capsule", "box", "surface"};
constexpr Keys obstacle_shape_keys[] = {"half_space", "sphere", "capsule", "box", "surface"};
constexpr Keys surface_keys[] = {"file", "scale"};
constexpr Keys half_space_keys[] = {"point", "normal"};
constexpr Keys shape_sphere_keys[] = {"radius"};
constexpr Keys capsule_keys[] = {"from", "to", "radius"};
constexpr Keys shape_box_keys[] = {"size"};
constexpr Keys tighten_keys[] = {"over", "length"};

/// Reads the shape that one of the keys sphere, capsule and box of a table gives. Returns nothing
/// without one.
std::optional<cutting::CarverShape> read_shape(const TableReader& shape) {
    std::optional<cutting::CarverShape> found;
    const auto radius_of = [](const TableReader& table) {
        table.require("radius", "a length, as in radius = 0.008");
        return table.number("radius", 1.0, limits::positive);
    };
    if (const auto sphere = shape.table("sphere", {shape_sphere_keys}))
        found = cutting::Sphere{radius_of(*sphere)};
    if (const auto capsule = shape.table("capsule", {capsule_keys})) {
        capsule->require("from", "one end of its axis, as in from = [0, 0, 0]");
        capsule->require("to", "the other end of its axis, as in to = [0, 0, 0.1]");
        found =
            cutting::Capsule{capsule->vector("from"), capsule->vector("to"), radius_of(*capsule)};
    }
    if (const auto box = shape.table("box", {shape_box_keys})) {
        box->require("size", "edge lengths, as in size = [0.01, 0.01, 0.02]");
        const Vec3 size = box->vector("size", Vec3::Ones());
        if (!(size.minCoeff() > 0.0))
            box->error("size", "is not allowed: all three lengths must be above 0");
        found = cutting::Cuboid{size};
    }
    return found;
}

}  // namespace

std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool) {
    const auto shape = tool.table("shape", {shape_keys});
    if (!shape) return std::nullopt;
    shape->one_of({"sphere", "capsule", "box"});
    return read_shape(*shape);
}

namespace {

/// Reads the key `shape` of a probe or an obstacle. Without a sound one, the shape is that of a
/// default probe.
ProbeSpec read_solid(const TableReader& tool, bool is_obstacle,
                     const std::filesystem::path& folder) {
    ProbeSpec spec;
    spec.probe.friction = tool.number("friction", spec.probe.friction, limits::non_negative);
    const auto shape = is_obstacle ? tool.table("shape", {obstacle_shape_keys})
                                   : tool.table("shape", {probe_shape_keys});
    if (!shape) return spec;
    if (is_obstacle)
        shape->one_of({"half_space", "sphere", "capsule", "box", "surface"});
    else
        shape->one_of({"sphere", "capsule", "box", "surface"});
    if (const auto found = read_shape(*shape))
        std::visit([&](const auto& one) { spec.probe.shape = one; }, *found);
    if (const auto surface = shape->table("surface", {surface_keys})) {
        surface->require("file", "a closed surface, as in file = \"probe.stl\"");
        spec.location = surface->location_text("file");
        auto file = read_file_name(*surface, "file", folder, "surface file (STL, OBJ, PLY or OFF)");
        if (surface->has("file") && surface->is_sound("file")) spec.surface = std::move(file);
        spec.scale = surface->number("scale", 1.0, limits::positive);
    }
    if (!is_obstacle) return spec;
    if (const auto half_space = shape->table("half_space", {half_space_keys})) {
        half_space->require("point", "a point of its surface, as in point = [0, 0, 0]");
        half_space->require("normal", "towards the free side, as in normal = [0, 0, 1]");
        spec.probe.shape = cutting::HalfSpace{half_space->vector("point"),
                                              half_space->direction("normal", Vec3::UnitZ())};
    }
    return spec;
}

}  // namespace

ProbeSpec read_probe(const TableReader& tool, const std::filesystem::path& folder) {
    return read_solid(tool, false, folder);
}

ProbeSpec read_obstacle(const TableReader& obstacle, const std::filesystem::path& folder) {
    return read_solid(obstacle, true, folder);
}

GrasperSpec read_grasper(const TableReader& tool) {
    GrasperSpec spec;
    spec.grasper.max_force =
        tool.number("max_force", spec.grasper.max_force, {.low = 0.0, .includes_high = true});
    spec.close = tool.number("close", 0.0, limits::non_negative);
    spec.open = tool.number_if_given("open", limits::non_negative);
    if (spec.open && *spec.open <= spec.close && tool.is_sound("open") && tool.is_sound("close"))
        tool.error("open", format_number(*spec.open) +
                               " is not allowed: must be after 'close', at " +
                               format_number(spec.close) + " s");
    if (const auto shape = read_shape_of(tool)) spec.grasper.jaws = *shape;
    return spec;
}

SutureSpec read_suture(const TableReader& tool) {
    SutureSpec spec;
    cutting::Suture& suture = spec.suture;
    suture.points = tool.vectors("points");
    if (tool.has("points") && tool.is_sound("points") && suture.points.size() < 2)
        tool.error("points", "must have at least 2 points");
    for (std::size_t i = 1; i < suture.points.size() && tool.is_sound("points"); ++i)
        if (suture.points[i] == suture.points[i - 1])
            tool.error("points", "points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                                     " (from 0) are the same: leave one out");
    suture.stiffness = tool.number("stiffness", 1.0, limits::positive);
    suture.max_force =
        tool.number("max_force", suture.max_force, {.low = 0.0, .includes_high = true});
    suture.reach = tool.number("reach", 0.0, limits::positive);
    if (const auto tighten = tool.table("tighten", {tighten_keys})) {
        tighten->require("length", "to which the thread is drawn, m, as in length = 0.001");
        tighten->require("over", "how long it is drawn, seconds, as in over = 0.2");
        spec.over = tighten->number("over", 1.0, limits::positive);
        spec.length = tighten->number_if_given("length", limits::non_negative);
    }
    return spec;
}

void check_jaws(const TableReader& tool, const GrasperSpec& grasper, double first, double last) {
    const auto within = " is not allowed: must be within the path, from " + format_number(first) +
                        " to " + format_number(last) + " s";
    if (tool.is_sound("close") && !(grasper.close >= first && grasper.close < last))
        tool.error("close", format_number(grasper.close) + within);
    if (tool.is_sound("open") && grasper.open && !(*grasper.open <= last))
        tool.error("open", format_number(*grasper.open) + within);
}

}  // namespace incise::scenario
