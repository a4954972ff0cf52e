// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/tools/tool_shapes.h"

#include <utility>

#include "incise/base/number_format.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys shape_keys[] = {"sphere", "capsule", "box"};
constexpr Keys ball_keys[] = {"radius"};
constexpr Keys capsule_keys[] = {"from", "to", "radius"};
constexpr Keys block_keys[] = {"size"};

Entry described(const cutting::Sphere& sphere) {
    return {"sphere", {}, value_of(Table{{"radius", {}, value_of(sphere.radius)}})};
}
Entry described(const cutting::Capsule& capsule) {
    return {"capsule",
            {},
            value_of(Table{{"from", {}, value_of(capsule.from)},
                           {"to", {}, value_of(capsule.to)},
                           {"radius", {}, value_of(capsule.radius)}})};
}
Entry described(const cutting::Cuboid& box) {
    return {"box", {}, value_of(Table{{"size", {}, value_of(box.size)}})};
}

}  // namespace

std::optional<cutting::CarverShape> read_simple_shape(const TableReader& shape) {
    std::optional<cutting::CarverShape> found;
    const auto radius_of = [](const TableReader& table) {
        table.require("radius", "a length, as in radius = 0.008");
        return table.number("radius", 1.0, limits::positive);
    };
    if (const auto sphere = shape.table("sphere", {ball_keys}))
        found = cutting::Sphere{radius_of(*sphere)};
    if (const auto capsule = shape.table("capsule", {capsule_keys})) {
        capsule->require("from", "one end of its axis, as in from = [0, 0, 0]");
        capsule->require("to", "the other end of its axis, as in to = [0, 0, 0.1]");
        found =
            cutting::Capsule{capsule->vector("from"), capsule->vector("to"), radius_of(*capsule)};
    }
    if (const auto box = shape.table("box", {block_keys})) {
        box->require("size", "edge lengths, as in size = [0.01, 0.01, 0.02]");
        const Vec3 size = box->vector("size", Vec3::Ones());
        if (!(size.minCoeff() > 0.0))
            box->error("size", "is not allowed: all three lengths must be above 0");
        found = cutting::Cuboid{size};
    }
    return found;
}

std::optional<cutting::CarverShape> read_shape_of(const TableReader& tool) {
    const auto shape = tool.table("shape", {shape_keys});
    if (!shape) return std::nullopt;
    shape->one_of({"sphere", "capsule", "box"});
    return read_simple_shape(*shape);
}

double read_snap(const TableReader& tool) {
    constexpr Limits allowed{.low = 0.0, .high = 0.5, .includes_low = true, .includes_high = true};
    // A tool of an unknown kind is read as several kinds, and what is wrong is told once.
    if (!tool.is_sound("snap")) return cutting::default_snap;
    return tool.number("snap", cutting::default_snap, allowed);
}

std::vector<Vec3> read_line(const TableReader& tool, std::string_view key) {
    std::vector<Vec3> points = tool.vectors(key);
    const bool knows_all = tool.is_sound(key);  // otherwise some points are missing
    if (tool.has(key) && knows_all && points.size() < 2)
        tool.error(key, "must have at least 2 points");
    for (std::size_t i = 1; i < points.size() && knows_all; ++i)
        if (points[i] == points[i - 1])
            tool.error(key, "points " + std::to_string(i - 1) + " and " + std::to_string(i) +
                                " (from 0) are the same: leave one out");
    return points;
}

void read_jaw_times(const TableReader& tool, ToolSpec& spec) {
    spec.close = tool.number("close", 0.0, limits::non_negative);
    spec.open = tool.number_if_given("open", limits::non_negative);
    if (spec.open && *spec.open <= *spec.close && tool.is_sound("open") && tool.is_sound("close"))
        tool.error("open", format_number(*spec.open) +
                               " is not allowed: must be after 'close', at " +
                               format_number(*spec.close) + " s");
}

void check_jaw_times(const TableReader& tool, const ToolSpec& spec) {
    if (spec.path.size() < 2) return;
    const double first = spec.path.front().time, last = spec.path.back().time;
    const auto within = " is not allowed: must be within the path, from " + format_number(first) +
                        " to " + format_number(last) + " s";
    if (tool.is_sound("close") && !(*spec.close >= first && *spec.close < last))
        tool.error("close", format_number(*spec.close) + within);
    if (tool.is_sound("open") && spec.open && !(*spec.open <= last))
        tool.error("open", format_number(*spec.open) + within);
}

Extent extent_of(const cutting::CarverShape& shape) {
    if (const auto* sphere = std::get_if<cutting::Sphere>(&shape))
        return {{Vec3::Zero()}, sphere->radius};
    if (const auto* capsule = std::get_if<cutting::Capsule>(&shape))
        return {{capsule->from, capsule->to}, capsule->radius};
    Extent extent;
    const Vec3 half = 0.5 * std::get<cutting::Cuboid>(shape).size;
    for (const double x : {-half.x(), half.x()})
        for (const double y : {-half.y(), half.y()})
            for (const double z : {-half.z(), half.z()}) extent.points.emplace_back(x, y, z);
    return extent;
}

Value value_of(double number) { return {number, {}}; }
Value value_of(const Vec3& vector) {
    return {Array{value_of(vector.x()), value_of(vector.y()), value_of(vector.z())}, {}};
}
Value value_of(std::span<const Vec3> points) {
    Array array;
    for (const Vec3& point : points) array.push_back(value_of(point));
    return {std::move(array), {}};
}
Value value_of(Table table) { return {std::move(table), {}}; }

Entry shape_entry(const cutting::CarverShape& shape) {
    return {"shape",
            {},
            value_of(Table{std::visit([](const auto& one) { return described(one); }, shape)})};
}

}  // namespace incise::scenario
