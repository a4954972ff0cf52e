// Reads the [[tool]] sections of a scenario.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <map>
#include <string_view>
#include <vector>

#include "incise/base/number_format.h"
#include "incise/scenario/scenario_sections.h"
#include "incise/scenario/tools/tool_kind.h"

namespace incise::scenario {

namespace {

using Keys = std::string_view;

constexpr Keys obstacle_keys[] = {"name", "shape", "friction", "path"};
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

/// Returns the names of all kinds, and the keys of all of them.
std::vector<Keys> names_of_kinds() {
    std::vector<Keys> names;
    for (const ToolKind* kind : tool_kinds()) names.push_back(kind->name());
    return names;
}
const std::vector<Keys>& all_keys() {
    static const std::vector<Keys> all = [] {
        std::vector<Keys> keys{"kind", "name", "path", "time"};
        for (const ToolKind* kind : tool_kinds())
            for (const ToolKey& key : kind->keys())
                if (std::ranges::find(keys, key.name) == keys.end()) keys.push_back(key.name);
        return keys;
    }();
    return all;
}

/// What moves a tool.
enum class Led { by_path, by_hand };

/// Reports the keys that say when a tool is where, if a hand does.
void refuse_times(const TableReader& tool) {
    std::vector<Keys> times{"path", "time"};
    for (const ToolKind* kind : tool_kinds())
        for (const ToolKey& key : kind->keys())
            if (key.is_time && std::ranges::find(times, key.name) == times.end())
                times.push_back(key.name);
    for (const Keys key : times)
        if (tool.has(key))
            tool.error(key,
                       "belongs to a tool of a scenario: this one is led by hand; leave it out");
}

bool has_key(const ToolKind& kind, Keys key) {
    return std::ranges::find(kind.keys(), key, &ToolKey::name) != kind.keys().end();
}

/// Reports keys that a tool of this kind needs but does not have, and keys of other kinds. Returns
/// false if it is not known what the tool is.
bool check_keys(const TableReader& tool, const ToolKind& kind, Led led) {
    const bool has_times = led == Led::by_path;
    if (!has_times) refuse_times(tool);
    for (const ToolKey& key : kind.keys())
        if (!key.hint.empty() && (has_times || !key.is_time)) tool.require(key.name, key.hint);
    const bool has_all = kind.has_all(tool);
    std::vector<Keys> judged;
    for (const ToolKind* other : tool_kinds())
        for (const ToolKey& key : other->keys()) {
            const bool is_own = has_key(kind, key.name);
            const bool is_known = std::ranges::find(judged, key.name) != judged.end();
            if (is_own || is_known || !tool.has(key.name) || (key.is_time && !has_times)) continue;
            judged.push_back(key.name);
            const std::string advice = kind.advice_on(key.name);
            tool.error(key.name, advice.empty()
                                     ? "belongs to " + owners_of(key.name) + ": leave it out"
                                     : advice);
        }
    if (!has_times) return has_all;
    if (kind.has_path()) {
        if (tool.has("time")) tool.error("time", "belongs to a cut or a suture: leave it out");
        tool.require("path",
                     "as in path = [{ time = 0, at = [0, 0, 0.1] }, { time = 1, at = [0, 0, 0] }]");
    } else {
        if (tool.has("path")) tool.error("path", std::string(kind.motion().why_no_path));
        tool.require("time", kind.motion().time_hint);
    }
    return has_all;
}

/// True if nothing is wrong with what says where the tool is.
bool knows_where(const TableReader& tool, const ToolKind& kind) {
    return tool.is_sound("path") && std::ranges::all_of(kind.keys(), [&](const ToolKey& key) {
               return !key.tells_where || tool.is_sound(key.name);
           });
}

void check_path(const TableReader& tool, const ToolKind& kind, const ToolSpec& spec,
                double end_time) {
    if (spec.path.size() == 1 && !kind.motion().why_two_keys.empty())
        tool.error("path",
                   "must have at least 2 times: " + std::string(kind.motion().why_two_keys));
    kind.check_times(tool, spec, end_time);
    if (end_time > 0.0 && !spec.path.empty() && spec.path.front().time > end_time)
        tool.warning(tool.has("time") ? "time" : "path",
                     "tool " + in_quotes(spec.name) + " starts at " +
                         format_number(spec.path.front().time) + " s, after the end at " +
                         format_number(end_time) + " s");
}

/// Reports a tool that touches tissue where there is no contact.
void check_contact(const TableReader& tool, const ToolKind& kind,
                   const std::string& why_no_contact) {
    if (why_no_contact.empty()) return;
    if (kind.traits().touches)
        tool.error("kind", in_quotes(kind.name()) + " touches tissue, but " + why_no_contact);
    else if (has_key(kind, "toughness") && tool.has("toughness"))
        tool.error("toughness",
                   "gives a force of cutting, which needs contact, but " + why_no_contact);
}

/// Reads a tool without a known kind.
void read_unknown(const TableReader& tool, const std::filesystem::path& folder, ToolSpec& spec) {
    for (const ToolKind* kind : tool_kinds())
        if (kind->reads_unknown_kinds()) kind->read(tool, folder, spec);
}

/// Reads the kind of a tool; null if it is not known.
const ToolKind* read_kind(const TableReader& tool) {
    const std::vector<Keys> names = names_of_kinds();
    tool.require("kind", "must be one of " + list_of(names));
    const auto index = tool.choice("kind", {names});
    return index ? tool_kinds()[*index] : nullptr;
}

}  // namespace

ToolSpec read_hand_tool(const Table& table, const std::filesystem::path& folder,
                        const std::string& why_no_contact, Diagnostics& diagnostics) {
    const TableReader tool(table, SourceLocation{}, "", {all_keys()}, diagnostics);
    ToolSpec spec;
    const ToolKind* kind = read_kind(tool);
    if (!kind) return spec;
    if (tool.has("name")) tool.error("name", "is given where the tool is added: leave it out");
    check_keys(tool, *kind, Led::by_hand);
    check_contact(tool, *kind, why_no_contact);
    spec.name = kind->name();
    kind->read(tool, folder, spec);
    return spec;
}

std::vector<ToolSpec> read_tools(const TableReader& root, const std::filesystem::path& folder,
                                 double end_time, const std::string& why_no_contact) {
    std::vector<ToolSpec> specs;
    std::vector<std::string> names;
    std::map<const ToolKind*, int> counts;
    for (const auto& tool : root.tables("tool", {all_keys()})) {
        const ToolKind* kind = read_kind(tool);
        ToolSpec spec;
        spec.location = tool.location_text();
        const std::string usual_name =
            kind ? std::string(kind->name()) + "_" + std::to_string(++counts[kind]) : "";
        if (kind || tool.has("name")) spec.name = read_name(tool, usual_name, names);
        const bool has_all = kind && check_keys(tool, *kind, Led::by_path);
        if (kind) check_contact(tool, *kind, why_no_contact);
        if (kind)
            kind->read(tool, folder, spec);
        else
            read_unknown(tool, folder, spec);
        if (!kind || !kind->has_path()) {
            const double time = tool.number("time", 0.0, limits::non_negative);
            if (tool.is_sound("time")) spec.path = {{time, {}}};
        }
        if (!kind || kind->has_path())
            spec.path = read_time_keys<Pose>(tool, "path", {pose_keys}, end_time, read_pose);
        // Without a known kind, only the file of a surface can be checked further.
        if (!kind && !spec.surface) continue;
        if (kind) check_path(tool, *kind, spec, end_time);
        if (!has_all || !knows_where(tool, *kind)) spec.path.clear();
        specs.push_back(std::move(spec));
    }
    int count = 0;
    for (const auto& obstacle : root.tables("obstacle", {obstacle_keys})) {
        ToolSpec spec;
        read_obstacle(obstacle, folder, spec);
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
