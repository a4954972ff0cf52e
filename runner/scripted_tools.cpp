// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/runner/scripted_tools.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "incise/base/number_format.h"

namespace incise::runner {

ScriptedTools::ScriptedTools(sim::World& world, std::vector<scenario::ScriptedTool> tools) {
    for (scenario::ScriptedTool& tool : tools) {
        world.add_tool({std::move(tool.name), std::move(tool.shape)});
        scripts_.push_back({std::move(tool.path), tool.close, tool.open, tool.over, tool.length});
    }
}

void ScriptedTools::lead(sim::World& world, double from, double to, sim::StepInputs& inputs,
                         std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i < scripts_.size(); ++i) {
        const scenario::ToolPath& path = scripts_[i].path;
        const sim::ToolId tool = world.tools()[i];
        if (std::holds_alternative<cutting::Suture>(world.tool(tool).shape)) {
            draw_suture(world, tool, from, to, inputs, warnings);
            continue;
        }
        if (!path.is_present(from, to)) continue;
        if (!world.is_tool_present(tool)) world.place_tool(tool, path.pose(from));
        move_jaws(world, tool, from, warnings);
        inputs.move(tool, path.pose(to));
        if (to < path.last_time()) continue;
        const auto before = path.pose_before_end();
        inputs.withdraw(tool, before ? &*before : nullptr);
    }
}

/// Closes or opens a tool at the beginning of a step.
void ScriptedTools::move_jaws(sim::World& world, sim::ToolId tool, double time,
                              std::vector<std::string>& warnings) {
    const auto& [path, close, open, over, length] = scripts_[tool.index];
    if (!close) return;
    const bool is_to_be_closed = time >= *close && !(open && time >= *open);
    if (is_to_be_closed == world.is_tool_closed(tool)) return;
    if (!is_to_be_closed) return world.open_tool(tool);
    if (world.close_tool(tool) == 0 && cutting::traits_of(world.tool(tool).shape).holds) {
        lost_.push_back(tool.index);
        warnings.push_back("grasper '" + world.tool(tool).name +
                           "' closes on nothing at t = " + format_number(time) +
                           " s; check where its path and the tissue are then");
    }
}

/// Ties a suture at its time, and draws its thread.
void ScriptedTools::draw_suture(sim::World& world, sim::ToolId tool, double from, double to,
                                sim::StepInputs& inputs, std::vector<std::string>& warnings) const {
    const Script& script = scripts_[tool.index];
    const double begin = script.path.first_time(), end = begin + script.over;
    // The first step that begins at its time, or the last one that can.
    if (!world.is_tool_present(tool)) {
        if (to <= begin) return;
        const std::size_t num_points =
            std::get<cutting::Suture>(world.tool(tool).shape).points.size();
        if (const std::size_t num_found = world.tie_suture(tool); num_found < num_points)
            warnings.push_back("suture '" + world.tool(tool).name + "', at t = " +
                               format_number(from) + " s: of its " + std::to_string(num_points) +
                               " points, " + std::to_string(num_points - num_found) +
                               " have no tissue any more, and are left out");
    }
    const double now = world.suture_length(tool);
    if (!script.length || now == *script.length) return;
    const double start = std::max(begin, from);
    const double part = to >= end ? 1.0 : (to - start) / (end - start);
    inputs.draw(tool, now + part * (*script.length - now));
}

void ScriptedTools::warn_of_lost_holds(const sim::World& world,
                                       std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i < scripts_.size(); ++i) {
        const sim::ToolId tool = world.tools()[i];
        if (cutting::traits_of(world.tool(tool).shape).holds && world.is_tool_closed(tool) &&
            world.num_held(tool) == 0 && std::ranges::find(lost_, i) == lost_.end()) {
            lost_.push_back(i);
            warnings.push_back("grasper '" + world.tool(tool).name +
                               "' holds nothing from t = " + format_number(world.time()) +
                               " s on: all tissue has slipped out of its jaws, or was removed");
            continue;
        }
        const bool is_suture = std::holds_alternative<cutting::Suture>(world.tool(tool).shape);
        if (!is_suture || !world.is_tool_present(tool) || world.is_suture_tied(tool) ||
            std::ranges::find(lost_, i) != lost_.end())
            continue;
        lost_.push_back(i);
        warnings.push_back("suture '" + world.tool(tool).name +
                           "' holds nothing from t = " + format_number(world.time()) +
                           " s on: its thread has torn at max_force, or its tissue was removed");
    }
}

}  // namespace incise::runner
