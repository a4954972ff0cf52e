// What a program does with the tools, constraints and loads of a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "incise/base/error.h"
#include "incise/python/world_driver.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/held_tool.h"

namespace incise::python {

namespace {

/// Throws InputError unless a name may be used in files, as those of scenarios.
void require_name(const std::string& what, const std::string& name) {
    const auto is_allowed = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '-';
    };
    if (name.empty() || !std::ranges::all_of(name, is_allowed))
        throw InputError(what + ": the name " + scenario::in_quotes(name) +
                         " is not allowed: use letters, digits, _ and -");
}

void require_sound(const std::string& what, const Pose& pose) {
    if (!pose.is_sound())
        throw InputError(what +
                         ": its pose must have a finite position, m, and a rotation of length 1");
}

}  // namespace

sim::ToolId WorldDriver::add_tool(const std::string& name, const scenario::Value& definition,
                                  const std::optional<Pose>& pose) {
    require_name("tool", name);
    if (world_.find_tool(name))
        throw InputError("tool '" + name + "': the world has a tool of this name already");
    if (pose) require_sound("tool '" + name + "'", *pose);
    scenario::HeldTool held = [&] {
        try {
            return scenario::build_held_tool(
                definition, scenario_.folder, world_.mesh(),
                scenario::why_no_contact(scenario_.dynamics, scenario_.contact));
        } catch (const InputError& error) {
            throw InputError("tool '" + name + "': " + error.what());
        }
    }();
    if (pose && !cutting::traits_of(held.shape).has_pose)
        throw InputError("tool '" + name + "': a suture has no pose: its points are in the tissue");
    const bool is_cut = cutting::traits_of(held.shape).is_at_once;
    if (pose && is_cut)
        throw InputError("tool '" + name +
                         "': a cut has no pose: it lies in the frame of the world");
    const sim::ToolId tool = world_.add_tool({name, std::move(held.shape)});
    led_.resize(world_.tools().size());
    note_tools();
    add_warnings(held.warnings);
    if (pose || is_cut) world_.place_tool(tool, pose.value_or(Pose()));
    if (is_cut) world_.withdraw_tool(tool);  // after it has cut in the next step
    return tool;
}

std::optional<Pose> WorldDriver::tool_pose(sim::ToolId tool) const {
    if (led_.at(tool.index).target) return led_[tool.index].target;
    if (!world_.is_tool_present(tool)) return std::nullopt;
    return world_.tool_pose(tool);
}

void WorldDriver::require_led(sim::ToolId tool) const {
    if (is_scripted(tool))
        throw InputError("tool '" + world_.tool(tool).name +
                         "' is led by the scenario, and cannot be led by hand");
}

void WorldDriver::require_posable(sim::ToolId tool, const Pose& pose) const {
    require_led(tool);
    const sim::ToolDef& def = world_.tool(tool);
    require_sound("tool '" + def.name + "'", pose);
    if (!cutting::traits_of(def.shape).has_pose)
        throw InputError("tool '" + def.name + "' is a suture, which has no pose: use tie()");
    if (cutting::traits_of(def.shape).is_at_once)
        throw InputError("tool '" + def.name +
                         "' is a cut, which has no pose; add another tool for another cut");
}

void WorldDriver::set_tool_target(sim::ToolId tool, const Pose& pose) {
    require_posable(tool, pose);
    led_[tool.index].target = pose;
}

void WorldDriver::place_tool(sim::ToolId tool, const Pose& pose) {
    require_posable(tool, pose);
    world_.place_tool(tool, pose);
    led_[tool.index] = {};
}

void WorldDriver::withdraw_tool(sim::ToolId tool) {
    require_led(tool);
    Led& led = led_[tool.index];
    const sim::ToolDef& def = world_.tool(tool);
    if (!cutting::traits_of(def.shape).has_pose)
        throw InputError("tool '" + def.name + "' is a suture: use untie()");
    if (!world_.is_tool_present(tool) && !led.target)
        throw InputError("tool '" + def.name + "' is not there to be withdrawn");
    led.leaves = true;
}

std::size_t WorldDriver::close(sim::ToolId tool) {
    require_led(tool);
    return world_.close_tool(tool);
}

void WorldDriver::open(sim::ToolId tool) {
    require_led(tool);
    world_.open_tool(tool);
}

std::size_t WorldDriver::tie(sim::ToolId tool) {
    require_led(tool);
    const std::size_t num_points = world_.tie_suture(tool);
    led_[tool.index] = {};
    return num_points;
}

void WorldDriver::untie(sim::ToolId tool) {
    require_led(tool);
    world_.untie_suture(tool);
    led_[tool.index] = {};
}

void WorldDriver::set_suture_target(sim::ToolId tool, double length) {
    require_led(tool);
    // The world checks the length, and that the tool is a tied suture.
    world_.set_suture_length(tool, length);
    led_[tool.index].length_target = length;
}

sim::ToolState WorldDriver::tool_state(sim::ToolId tool) const {
    for (const sim::ToolState& state : world_.report().tools)
        if (state.tool == tool) return state;
    sim::ToolState absent{};
    absent.tool = tool;
    return absent;
}

// --- Constraints and loads

namespace {
auto find_constraint(auto& constraints, const std::string& name) {
    const auto found = std::ranges::find(constraints, name, &NamedConstraint::name);
    if (found == constraints.end()) throw InputError("the world has no constraint '" + name + "'");
    return found;
}
}  // namespace

void WorldDriver::grasp(const std::string& name, std::vector<VertexId> nodes, const Pose& pose) {
    require_name("grasp", name);
    if (std::ranges::find(constraints_, name, &NamedConstraint::name) != constraints_.end())
        throw InputError("grasp '" + name + "': the world has a constraint of this name already");
    const sim::ConstraintId id = world_.grasp(name, std::move(nodes), pose);
    constraints_.push_back({name, id, pose, {}});
}

void WorldDriver::set_grasp_target(const std::string& name, const Pose& pose) {
    const auto found = find_constraint(constraints_, name);
    if (!found->pose)
        throw InputError("constraint '" + name + "' is no grasp: the scenario says how it moves");
    require_sound("grasp '" + name + "'", pose);
    found->target = pose;
}

void WorldDriver::release(const std::string& name) {
    const auto found = find_constraint(constraints_, name);
    world_.release(found->id);
    constraints_.erase(found);
}

const physics::Load& WorldDriver::load(const std::string& name) const {
    const auto found = std::ranges::find(loads_, name);
    if (found == loads_.end()) throw InputError("the world has no load '" + name + "'");
    return world_.model().loads().all()[static_cast<std::size_t>(found - loads_.begin())];
}

void WorldDriver::set_load_factor(const std::string& name, double factor) {
    load(name);
    const auto found = std::ranges::find(loads_, name);
    world_.set_load_factor(world_.loads()[static_cast<std::size_t>(found - loads_.begin())],
                           factor);
}

}  // namespace incise::python
