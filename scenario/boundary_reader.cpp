// Reads the [[constraint]] and [[load]] sections of a scenario, and their selections.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/scenario/scenario_sections.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys selection_keys[] = {"box", "sphere", "half_space", "nodes", "region", "surface"};
constexpr Keys selection_box_keys[] = {"min", "max"};
constexpr Keys sphere_keys[] = {"center", "radius"};
constexpr Keys half_space_keys[] = {"point", "normal"};
constexpr Keys constraint_keys[] = {"name", "where", "fix", "move", "rotate", "about"};
constexpr Keys move_keys[] = {"time", "by"};
constexpr Keys rotate_keys[] = {"time", "angle"};
constexpr Keys about_keys[] = {"point", "axis"};
constexpr Keys load_keys[] = {"name",     "where",      "nodal_force", "traction",
                              "pressure", "body_force", "factor"};
constexpr Keys factor_keys[] = {"time", "value"};

sim::BoxRegion read_box(const TableReader& box) {
    box.require("min", "the lowest corner, as in min = [0, 0, 0]");
    box.require("max", "the highest corner, as in max = [1, 1, 1]");
    sim::BoxRegion region{box.vector("min"), box.vector("max")};
    if (box.is_sound("min") && box.is_sound("max") &&
        (region.max.array() < region.min.array()).any())
        box.error("max", "is not allowed: no coordinate may be below that of min");
    return region;
}

sim::SphereRegion read_sphere(const TableReader& sphere) {
    sphere.require("center", "a point, as in center = [0, 0, 0]");
    sphere.require("radius", "a length, as in radius = 0.01");
    return {sphere.vector("center"), sphere.number("radius", 1.0, limits::positive)};
}

sim::HalfSpaceRegion read_half_space(const TableReader& half_space) {
    half_space.require("point", "a point on its plane, as in point = [0, 0, 0]");
    half_space.require("normal", "the direction in which it lies, as in normal = [0, 0, 1]");
    return {half_space.vector("point"), half_space.direction("normal", Vec3::UnitZ())};
}

sim::Selection read_selection(const TableReader& owner) {
    sim::Selection selection;
    const auto where = owner.table("where", {selection_keys});
    if (!where) return selection;
    if (const auto box = where->table("box", {selection_box_keys})) selection.box = read_box(*box);
    if (const auto sphere = where->table("sphere", {sphere_keys}))
        selection.sphere = read_sphere(*sphere);
    if (const auto half_space = where->table("half_space", {half_space_keys}))
        selection.half_space = read_half_space(*half_space);
    if (where->has("nodes")) selection.nodes = where->integers("nodes", {.low = 0});
    if (where->has("region")) {
        const auto regions = where->integers("region", region_limits, Repeats::refused);
        selection.regions.emplace(regions.begin(), regions.end());
    }
    selection.surface = where->flag("surface", false);
    if (where->entries().empty())
        where->error({}, "is empty: give at least one of " + list_of(selection_keys));
    return selection;
}

std::array<bool, 3> read_axes(const TableReader& constraint) {
    std::array<bool, 3> axes{};
    const std::string text = constraint.text("fix");
    bool is_valid = !text.empty() || !constraint.is_text("fix");
    for (const char letter : text) {
        const auto axis = std::string_view("xyz").find(letter);
        is_valid = is_valid && axis < 3 && !axes[axis];
        if (axis < 3) axes[axis] = true;
    }
    if (!is_valid)
        constraint.error("fix", in_quotes(text) +
                                    " is not allowed: any of the letters x, y and z, each at "
                                    "most once, as in fix = \"xyz\"");
    return is_valid ? axes : std::array<bool, 3>{};
}

void read_motion(const TableReader& constraint, double end_time, ConstraintSpec& spec) {
    spec.move =
        read_time_keys<Vec3>(constraint, "move", {move_keys}, end_time, [](const TableReader& row) {
            row.require("by", "a displacement, as in by = [0, 0, 1]");
            return row.vector("by");
        });
    spec.rotate = read_time_keys<double>(constraint, "rotate", {rotate_keys}, end_time,
                                         [](const TableReader& row) {
                                             row.require("angle", "radians, as in angle = 0.3");
                                             return row.number("angle", 0.0);
                                         });
    if (constraint.has("rotate"))
        constraint.require("about",
                           "the axis of rotate, as in about = { point = [0, 0, 0], axis = "
                           "[0, 0, 1] }");
    else if (constraint.has("about"))
        constraint.error("about", "belongs to rotate, which is not there");
    if (const auto about = constraint.table("about", {about_keys})) {
        about->require("point", "a point on the axis, as in point = [0, 0, 0]");
        about->require("axis", "its direction, as in axis = [0, 0, 1]");
        spec.about_point = about->vector("point");
        spec.about_axis = about->direction("axis", spec.about_axis);
    }
}

ConstraintSpec read_constraint(const TableReader& constraint, double end_time) {
    ConstraintSpec spec;
    spec.location = constraint.location_text("where");
    constraint.require("where", "what it holds, as in where = { nodes = [0, 1, 2] }");
    spec.where = read_selection(constraint);
    spec.fixed = read_axes(constraint);
    read_motion(constraint, end_time, spec);
    const bool moves = constraint.has("move") || constraint.has("rotate");
    if (!constraint.has("fix") && moves) spec.fixed = {true, true, true};
    // Whether it agrees with other constraints cannot be judged then.
    if (!constraint.is_sound("move") || !constraint.is_sound("rotate") ||
        !constraint.is_sound("about"))
        spec.fixed = {};
    if (!constraint.has("fix") && !moves)
        constraint.error({}, "holds nothing: give fix = \"xyz\", or move, or rotate");
    return spec;
}

/// @param is_one_kind  set to true if the section has a load of one kind
LoadSpec read_load(const TableReader& load, double end_time, bool& is_one_kind) {
    LoadSpec spec;
    spec.location = load.location_text("where");
    spec.where = read_selection(load);
    is_one_kind = load.one_of({"nodal_force", "traction", "pressure", "body_force"}).has_value();
    if (load.has("nodal_force")) spec.load = NodalForce{load.vector("nodal_force")};
    if (load.has("traction")) spec.load = Traction{load.vector("traction")};
    if (load.has("pressure")) spec.load = Pressure{load.number("pressure", 0.0)};
    if (load.has("body_force")) spec.load = BodyForce{load.vector("body_force")};
    spec.factor =
        read_time_keys<double>(load, "factor", {factor_keys}, end_time, [](const TableReader& row) {
            row.require("value", "as in value = 1.0");
            return row.number("value", 1.0);
        });
    return spec;
}

constexpr const char* no_name = "is given where it is added: leave it out";

}  // namespace

ConstraintSpec read_added_constraint(const Table& table, Diagnostics& diagnostics) {
    const TableReader constraint(table, SourceLocation{}, "", {constraint_keys}, diagnostics);
    if (constraint.has("name")) constraint.error("name", no_name);
    return read_constraint(constraint, 0.0);
}

LoadSpec read_added_load(const Table& table, Diagnostics& diagnostics) {
    const TableReader load(table, SourceLocation{}, "", {load_keys}, diagnostics);
    if (load.has("name")) load.error("name", no_name);
    bool is_one_kind = false;
    return read_load(load, 0.0, is_one_kind);
}

std::vector<ConstraintSpec> read_constraints(const TableReader& root, double end_time,
                                             std::vector<std::string>& names) {
    std::vector<ConstraintSpec> specs;
    std::size_t number = 0;
    for (const auto& constraint : root.tables("constraint", {constraint_keys})) {
        const std::string usual_name = "constraint_" + std::to_string(++number);
        std::string name = read_name(constraint, usual_name, names);
        ConstraintSpec spec = read_constraint(constraint, end_time);
        spec.name = std::move(name);
        if (constraint.is_sound("where")) specs.push_back(std::move(spec));
    }
    return specs;
}

std::vector<LoadSpec> read_loads(const TableReader& root, double end_time) {
    std::vector<LoadSpec> specs;
    std::vector<std::string> names;
    std::size_t number = 0;
    for (const auto& load : root.tables("load", {load_keys})) {
        std::string name = read_name(load, "load_" + std::to_string(++number), names);
        bool is_one_kind = false;
        LoadSpec spec = read_load(load, end_time, is_one_kind);
        spec.name = std::move(name);
        if (is_one_kind && load.is_sound("where")) specs.push_back(std::move(spec));
    }
    return specs;
}

}  // namespace incise::scenario
