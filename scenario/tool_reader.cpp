// Reads the [[tool]] sections of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/base/number_format.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/touching_tools.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys tool_keys[] = {
    "kind",      "name",      "path",          "shape",  "edge",     "mode",      "snap",
    "time",      "plane",     "surface",       "scale",  "friction", "close",     "open",
    "max_force", "toughness", "cutting_force", "points", "tighten",  "stiffness", "reach"};
constexpr Keys obstacle_keys[] = {"name", "shape", "friction", "path"};
constexpr Keys kinds[] = {"carver", "blade", "cut", "probe", "grasper", "suture"};
constexpr Keys modes[] = {"split", "separate"};         // in the order of CutMode
constexpr Keys cutting_forces[] = {"report", "apply"};  // in the order of CuttingForce
constexpr Limits snap_limits{.low = 0.0, .high = 0.5, .includes_low = true, .includes_high = true};
constexpr Keys plane_keys[] = {"point", "normal"};
constexpr Keys pose_keys[] = {"time", "at", "rotate"};
constexpr Keys rotation_keys[] = {"axis", "angle"};

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

Carver read_carver(const TableReader& tool) {
    Carver carver;
    if (const auto shape = read_shape_of(tool)) carver.shape = *shape;
    return carver;
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
    blade.toughness = tool.number("toughness", 0.0, limits::positive);
    if (const auto force = tool.choice("cutting_force", {cutting_forces}))
        blade.cutting_force = static_cast<cutting::CuttingForce>(*force);
    if (tool.has("cutting_force"))
        tool.require("toughness", "energy to open an area, J/m2, as in toughness = 160");
    if (tool.has("toughness") && blade.mode == CutMode::separate)
        tool.error("toughness", "belongs to mode = \"split\": leave it out");
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

/// What moves a tool.
enum class Led { by_path, by_hand };

/// Reports the keys that say when a tool is where, if a hand does.
void refuse_times(const TableReader& tool) {
    for (const std::string_view key : {"path", "time", "close", "open", "tighten"})
        if (tool.has(key))
            tool.error(key,
                       "belongs to a tool of a scenario: this one is led by hand; leave it out");
}

/// Reports keys that a tool of this kind needs but does not have, and keys of other kinds.
void check_keys(const TableReader& tool, Keys kind, Led led) {
    const bool has_times = led == Led::by_path;
    if (!has_times) refuse_times(tool);
    if (kind == "carver" || kind == "probe" || kind == "grasper")
        tool.require("shape", "as in shape = { sphere = { radius = 0.008 } }");
    else
        refuse(tool, {"shape"}, "a carver, a probe or a grasper");
    if (has_times && kind == "grasper")
        tool.require("close", "when its jaws close, seconds, as in close = 0.2");
    else if (has_times)
        refuse(tool, {"close", "open"}, "a grasper");
    if (kind != "grasper" && kind != "suture") refuse(tool, {"max_force"}, "a grasper or a suture");
    if (kind == "suture") {
        tool.require("points",
                     "a line of points at rest, as in points = [[0, 0, 0], [0.01, 0, 0]]");
        tool.require("stiffness", "of the thread, N/m, as in stiffness = 200");
    } else {
        refuse(tool, {"points", "stiffness", "reach"}, "a suture");
        if (has_times) refuse(tool, {"tighten"}, "a suture");
    }
    if (kind != "probe") refuse(tool, {"friction"}, "a probe");
    if (kind == "blade")
        tool.require("edge", "a line of points, as in edge = [[-0.01, 0, 0], [0.01, 0, 0]]");
    else
        refuse(tool, {"edge", "mode", "toughness", "cutting_force"}, "a blade");
    if (kind != "blade" && kind != "cut") refuse(tool, {"snap"}, "a blade");
    if (kind == "cut") {
        tool.one_of({"plane", "surface"});
        if (!has_times) return;
        refuse(tool, {"path"}, "a blade");
        tool.require("time", "when it cuts, seconds, as in time = 0.5");
        return;
    }
    if (kind == "probe" && tool.has("surface"))
        tool.error("surface",
                   "goes into the shape, as in shape = { surface = { file = \"probe.stl\" } }");
    else
        refuse(tool, {"surface"}, "a cut");
    refuse(tool, {"plane", "scale"}, "a cut");
    if (!has_times) return;
    if (kind == "suture") {
        if (tool.has("path"))
            tool.error("path", "a suture has none: its points are in the tissue; leave it out");
        tool.require("time", "when it is tied, seconds, as in time = 0.5");
    } else {
        refuse(tool, {"time"}, "a cut or a suture");
        tool.require("path",
                     "as in path = [{ time = 0, at = [0, 0, 0.1] }, { time = 1, at = [0, 0, 0] }]");
    }
}

bool knows_where(const TableReader& tool, Keys kind) {
    constexpr Keys keys[] = {"path", "shape", "edge", "plane", "surface", "scale", "points"};
    return std::ranges::all_of(keys, [&](Keys key) { return tool.is_sound(key); }) &&
           (kind != "cut" || tool.has("plane") != tool.has("surface"));
}

void check_path(const TableReader& tool, const ToolSpec& spec, double end_time) {
    if (std::holds_alternative<BladeSpec>(spec.kind) && spec.path.size() == 1)
        tool.error("path", "must have at least 2 times: a blade cuts where it moves");
    if (const auto* grasper = std::get_if<GrasperSpec>(&spec.kind)) {
        if (spec.path.size() == 1)
            tool.error("path",
                       "must have at least 2 times: a grasper is there from the first to the last");
        if (spec.path.size() > 1)
            check_jaws(tool, *grasper, spec.path.front().time, spec.path.back().time);
    }
    if (std::holds_alternative<ProbeSpec>(spec.kind) && spec.path.size() == 1)
        tool.error("path",
                   "must have at least 2 times: a probe is there from the first to the last; "
                   "for one that is always there, write an [[obstacle]]");
    if (const auto* suture = std::get_if<SutureSpec>(&spec.kind);
        suture && end_time > 0.0 && !spec.path.empty()) {
        const double time = spec.path.front().time;
        if (time == end_time)
            tool.warning("time", "tool " + in_quotes(spec.name) + " is tied at the end of the run");
        else if (suture->length && time < end_time && time + suture->over > end_time)
            tool.warning("tighten", "tool " + in_quotes(spec.name) + " is drawn until " +
                                        format_number(time + suture->over) +
                                        " s, after the end at " + format_number(end_time) + " s");
    }
    if (end_time > 0.0 && !spec.path.empty() && spec.path.front().time > end_time)
        tool.warning(tool.has("time") ? "time" : "path",
                     "tool " + in_quotes(spec.name) + " starts at " +
                         format_number(spec.path.front().time) + " s, after the end at " +
                         format_number(end_time) + " s");
}

/// Reports a tool that touches tissue where there is no contact.
void check_contact(const TableReader& tool, Keys kind, const std::string& why_no_contact) {
    if (why_no_contact.empty()) return;
    if (kind == "probe" || kind == "grasper" || kind == "suture")
        tool.error("kind", in_quotes(kind) + " touches tissue, but " + why_no_contact);
    if (kind == "blade" && tool.has("toughness"))
        tool.error("toughness",
                   "gives a force of cutting, which needs contact, but " + why_no_contact);
}

/// Reads what a tool is. An unknown kind is empty: its keys are read as far as they tell the kind.
auto read_kind(const TableReader& tool, Keys kind, const std::filesystem::path& folder) {
    decltype(ToolSpec::kind) spec;
    const auto may_be = [&](Keys one) { return kind.empty() || kind == one; };
    std::optional<double> snap;
    if (may_be("blade") || may_be("cut")) snap = tool.number_if_given("snap", snap_limits);
    if (may_be("carver")) spec = read_carver(tool);
    if (kind == "probe") spec = read_probe(tool, folder);
    if (kind == "grasper") spec = read_grasper(tool);
    if (kind == "suture") spec = read_suture(tool);
    if (may_be("blade")) spec = read_blade(tool, snap);
    if (may_be("cut")) spec = read_cut(tool, snap, folder);
    return spec;
}

}  // namespace

ToolSpec read_held_tool(const Table& table, const std::filesystem::path& folder,
                        const std::string& why_no_contact, Diagnostics& diagnostics) {
    const TableReader tool(table, SourceLocation{}, "", {tool_keys}, diagnostics);
    tool.require("kind", "must be one of " + list_of(kinds));
    ToolSpec spec;
    const auto index = tool.choice("kind", {kinds});
    if (!index) return spec;
    const Keys kind = kinds[*index];
    if (tool.has("name")) tool.error("name", "is given where the tool is added: leave it out");
    check_keys(tool, kind, Led::by_hand);
    check_contact(tool, kind, why_no_contact);
    spec.name = kind;
    spec.kind = read_kind(tool, kind, folder);
    return spec;
}

std::vector<ToolSpec> read_tools(const TableReader& root, const std::filesystem::path& folder,
                                 double end_time, const std::string& why_no_contact) {
    std::vector<ToolSpec> specs;
    std::vector<std::string> names;
    std::array<int, std::size(kinds)> counts{};
    for (const auto& tool : root.tables("tool", {tool_keys})) {
        tool.require("kind", "must be one of " + list_of(kinds));
        const auto index = tool.choice("kind", {kinds});
        const Keys kind = index ? kinds[*index] : Keys();  // empty if not known
        ToolSpec spec;
        spec.location = tool.location_text();
        const std::string usual_name =
            index ? std::string(kind) + "_" + std::to_string(++counts[*index]) : "";
        if (index || tool.has("name")) spec.name = read_name(tool, usual_name, names);
        if (index) check_keys(tool, kind, Led::by_path);
        check_contact(tool, kind, why_no_contact);
        spec.kind = read_kind(tool, kind, folder);
        if (kind.empty() || kind == "cut" || kind == "suture") {
            const double time = tool.number("time", 0.0, limits::non_negative);
            if (tool.is_sound("time")) spec.path = {{time, {}}};
        }
        if (kind != "cut" && kind != "suture")
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
        spec.kind = read_obstacle(obstacle, folder);
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
