// Reads the [[tool]] sections of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/io/files/number_format.h"
#include "incise/scenario/scenario_sections.h"

namespace incise::scenario {

namespace {

using io::format_number;
using Keys = std::string_view;

constexpr Keys tool_keys[] = {"kind",  "name",     "path",  "shape", "edge",
                              "mode",  "snap",     "time",  "plane", "surface",
                              "scale", "friction", "close", "open",  "max_force"};
constexpr Keys obstacle_keys[] = {"name", "shape", "friction", "path"};
constexpr Keys kinds[] = {"carver", "blade", "cut", "probe", "grasper"};
constexpr Keys modes[] = {"split", "separate"};  // in the order of CutMode
constexpr Limits snap_limits{.low = 0.0, .high = 0.5, .includes_low = true, .includes_high = true};
constexpr Keys plane_keys[] = {"point", "normal"};
constexpr Keys pose_keys[] = {"time", "at", "rotate"};
constexpr Keys rotation_keys[] = {"axis", "angle"};
constexpr Keys shape_keys[] = {"sphere", "capsule", "box"};
constexpr Keys obstacle_shape_keys[] = {"half_space", "sphere", "capsule", "box"};
constexpr Keys half_space_keys[] = {"point", "normal"};
constexpr Keys shape_sphere_keys[] = {"radius"};
constexpr Keys capsule_keys[] = {"from", "to", "radius"};
constexpr Keys shape_box_keys[] = {"size"};

Pose read_pose(const TableReader& row) {
    Pose pose;
    row.require("at", "where the tool's origin is, as in at = [0, 0, 0.1]");
    pose.position = row.vector("at");
    if (const auto rotation = row.table("rotate", {rotation_keys})) {
        rotation->require("axis", "its direction, as in axis = [1, 0, 0]");
        rotation->require("angle", "radians, as in angle = 0.2");
        const Vec3 axis = rotation->direction("axis", Vec3::UnitZ());
        pose.rotation = Eigen::AngleAxisd(rotation->number("angle", 0.0), axis);
    }
    return pose;
}

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

/// Reads the key `shape` of a tool. Returns nothing if it is missing or faulty.
std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool) {
    const auto shape = tool.table("shape", {shape_keys});
    if (!shape) return std::nullopt;
    shape->one_of({"sphere", "capsule", "box"});
    return read_shape(*shape);
}

Carver read_carver(const TableReader& tool) {
    Carver carver;
    if (const auto shape = read_shape_of(tool)) carver.shape = *shape;
    return carver;
}

cutting::Probe read_probe(const TableReader& tool) {
    cutting::Probe probe;
    probe.friction = tool.number("friction", probe.friction, limits::non_negative);
    if (const auto shape = read_shape_of(tool))
        std::visit([&](const auto& one) { probe.shape = one; }, *shape);
    return probe;
}

cutting::Probe read_obstacle(const TableReader& obstacle) {
    cutting::Probe probe;
    probe.friction = obstacle.number("friction", probe.friction, limits::non_negative);
    const auto shape = obstacle.table("shape", {obstacle_shape_keys});
    if (!shape) return probe;
    shape->one_of({"half_space", "sphere", "capsule", "box"});
    if (const auto found = read_shape(*shape))
        std::visit([&](const auto& one) { probe.shape = one; }, *found);
    if (const auto half_space = shape->table("half_space", {half_space_keys})) {
        half_space->require("point", "a point of its surface, as in point = [0, 0, 0]");
        half_space->require("normal", "towards the free side, as in normal = [0, 0, 1]");
        probe.shape = cutting::HalfSpace{half_space->vector("point"),
                                         half_space->direction("normal", Vec3::UnitZ())};
    }
    return probe;
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

BladeSpec read_blade(const TableReader& tool, std::optional<double> snap) {
    BladeSpec blade;
    blade.edge = tool.vectors("edge");
    const bool knows_edge = tool.is_sound("edge");  // otherwise some points are missing
    if (tool.has("edge") && knows_edge && blade.edge.size() < 2)
        tool.error("edge", "must have at least 2 points");
    for (std::size_t i = 1; i < blade.edge.size() && knows_edge; ++i)
        if (blade.edge[i] == blade.edge[i - 1])
            tool.error("edge", "points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                                   " (from 0) are the same: leave one out");
    if (const auto mode = tool.has("mode") ? tool.choice("mode", {modes}) : std::nullopt)
        blade.mode = static_cast<CutMode>(*mode);
    blade.snap = snap;
    if (blade.snap && blade.mode == CutMode::separate)
        tool.error("snap", "belongs to mode = \"split\": leave it out");
    return blade;
}

CutSpec read_cut(const TableReader& tool, std::optional<double> snap,
                 const std::filesystem::path& folder) {
    CutSpec cut;
    if (const auto plane = tool.table("plane", {plane_keys})) {
        plane->require("point", "a point of the plane, as in point = [0, 0, 0]");
        plane->require("normal", "across the plane, as in normal = [1, 0, 0]");
        cut.along = PlaneSpec{plane->vector("point"), plane->direction("normal", Vec3::UnitZ())};
    }
    cut.location = tool.location_text("surface");
    if (tool.has("surface")) {
        auto file = read_file_name(tool, "surface", folder, "surface file (STL, OBJ, PLY or OFF)");
        if (tool.is_sound("surface")) cut.along = std::move(file);
    }
    cut.scale = tool.number("scale", 1.0, limits::positive);
    if (tool.has("scale") && tool.has("plane") && !tool.has("surface"))
        tool.error("scale", "is for surfaces: leave it out");
    cut.snap = snap;
    return cut;
}

void refuse(const TableReader& tool, std::initializer_list<std::string_view> keys,
            const std::string& owner) {
    for (const auto key : keys)
        if (tool.has(key)) tool.error(key, "belongs to " + owner + ": leave it out");
}

/// Reports keys that a tool of this kind needs but does not have, and keys of other kinds.
void check_keys(const TableReader& tool, Keys kind) {
    if (kind == "carver" || kind == "probe" || kind == "grasper")
        tool.require("shape", "as in shape = { sphere = { radius = 0.008 } }");
    else
        refuse(tool, {"shape"}, "a carver, a probe or a grasper");
    if (kind == "grasper")
        tool.require("close", "when its jaws close, seconds, as in close = 0.2");
    else
        refuse(tool, {"close", "open", "max_force"}, "a grasper");
    if (kind != "probe") refuse(tool, {"friction"}, "a probe");
    if (kind == "blade")
        tool.require("edge", "a line of points, as in edge = [[-0.01, 0, 0], [0.01, 0, 0]]");
    else
        refuse(tool, {"edge", "mode"}, "a blade");
    if (kind != "blade" && kind != "cut") refuse(tool, {"snap"}, "a blade");
    if (kind == "cut") {
        tool.one_of({"plane", "surface"});
        refuse(tool, {"path"}, "a blade");
        tool.require("time", "when it cuts, seconds, as in time = 0.5");
    } else {
        refuse(tool, {"time", "plane", "surface", "scale"}, "a cut");
        tool.require("path",
                     "as in path = [{ time = 0, at = [0, 0, 0.1] }, { time = 1, at = [0, 0, 0] }]");
    }
}

bool knows_where(const TableReader& tool, Keys kind) {
    constexpr Keys keys[] = {"path", "shape", "edge", "plane", "surface", "scale"};
    return std::ranges::all_of(keys, [&](Keys key) { return tool.is_sound(key); }) &&
           (kind != "cut" || tool.has("plane") != tool.has("surface"));
}

/// Reports times of jaws that are not within the path.
void check_jaws(const TableReader& tool, const GrasperSpec& grasper, double first, double last) {
    const auto within = " is not allowed: must be within the path, from " + format_number(first) +
                        " to " + format_number(last) + " s";
    if (tool.is_sound("close") && !(grasper.close >= first && grasper.close < last))
        tool.error("close", format_number(grasper.close) + within);
    if (tool.is_sound("open") && grasper.open && !(*grasper.open <= last))
        tool.error("open", format_number(*grasper.open) + within);
}

void check_path(const TableReader& tool, const ToolSpec& spec, double end_time) {
    if (std::holds_alternative<BladeSpec>(spec.kind) && spec.path.size() == 1)
        tool.error("path", "must have at least 2 keys: a blade cuts where it moves");
    if (const auto* grasper = std::get_if<GrasperSpec>(&spec.kind)) {
        if (spec.path.size() == 1)
            tool.error("path",
                       "must have at least 2 keys: a grasper is there from the first to the last");
        if (spec.path.size() > 1)
            check_jaws(tool, *grasper, spec.path.front().time, spec.path.back().time);
    }
    if (std::holds_alternative<cutting::Probe>(spec.kind) && spec.path.size() == 1)
        tool.error("path",
                   "must have at least 2 keys: a probe is there from the first to the last; "
                   "for one that is always there, write an [[obstacle]]");
    if (end_time > 0.0 && !spec.path.empty() && spec.path.front().time > end_time)
        tool.warning(tool.has("time") ? "time" : "path",
                     "tool " + in_quotes(spec.name) + " starts at " +
                         format_number(spec.path.front().time) + " s, after the end at " +
                         format_number(end_time) + " s");
}

}  // namespace

std::vector<ToolSpec> read_tools(const TableReader& root, const std::filesystem::path& folder,
                                 double end_time, const std::string& why_no_contact) {
    std::vector<ToolSpec> specs;
    std::vector<std::string> names;
    std::array<int, std::size(kinds)> counts{};
    for (const auto& tool : root.tables("tool", {tool_keys})) {
        tool.require("kind", "must be one of " + list_of(kinds));
        const auto index = tool.choice("kind", {kinds});
        const Keys kind = index ? kinds[*index] : Keys();  // empty if not known
        const auto may_be = [&](Keys one) { return kind.empty() || kind == one; };
        ToolSpec spec;
        spec.location = tool.location_text();
        const std::string usual_name =
            index ? std::string(kind) + "_" + std::to_string(++counts[*index]) : "";
        if (index || tool.has("name")) spec.name = read_name(tool, usual_name, names);
        if (index) check_keys(tool, kind);
        if ((kind == "probe" || kind == "grasper") && !why_no_contact.empty())
            tool.error("kind", in_quotes(kind) + " touches tissue, but " + why_no_contact);
        std::optional<double> snap;
        if (kind.empty() || kind == "blade" || kind == "cut")
            snap = tool.number_if_given("snap", snap_limits);
        if (may_be("carver")) spec.kind = read_carver(tool);
        if (kind == "probe") spec.kind = read_probe(tool);
        if (kind == "grasper") spec.kind = read_grasper(tool);
        if (may_be("blade")) spec.kind = read_blade(tool, snap);
        if (may_be("cut")) {
            spec.kind = read_cut(tool, snap, folder);
            const double time = tool.number("time", 0.0, limits::non_negative);
            if (tool.is_sound("time")) spec.path = {{time, {}}};
        }
        if (kind != "cut")
            spec.path = read_time_keys<Pose>(tool, "path", {pose_keys}, end_time, read_pose);
        // Without a known kind, only the file of a surface can be checked further.
        if (!index && !tool.has("surface")) continue;
        if (index) check_path(tool, spec, end_time);
        if (!index || !knows_where(tool, kind)) spec.path.clear();
        specs.push_back(std::move(spec));
    }
    int count = 0;
    for (const auto& obstacle : root.tables("obstacle", {obstacle_keys})) {
        ToolSpec spec;
        spec.kind = read_obstacle(obstacle);
        spec.is_obstacle = true;
        spec.location = obstacle.location_text();
        spec.name = read_name(obstacle, "obstacle_" + std::to_string(++count), names);
        if (!why_no_contact.empty())
            obstacle.error({}, "an obstacle touches tissue, but " + why_no_contact);
        obstacle.require(
            "shape", "as in shape = { half_space = { point = [0, 0, 0], normal = [0, 0, 1] } }");
        spec.path = {{0.0, Pose()}};
        if (obstacle.has("path"))
            spec.path = read_time_keys<Pose>(obstacle, "path", {pose_keys}, end_time, read_pose);
        if (!obstacle.is_sound("path") || !obstacle.is_sound("shape")) spec.path.clear();
        specs.push_back(std::move(spec));
    }
    return specs;
}

}  // namespace incise::scenario
