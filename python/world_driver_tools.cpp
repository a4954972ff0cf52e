// What a program does with the tools, constraints and loads of a world.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <tuple>
#include <utility>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/python/world_driver.h"
#include "incise/scenario/added_parts.h"
#include "incise/scenario/diagnostics.h"
#include "incise/scenario/hand_tool.h"
#include "incise/topology/mesh_metrics.h"

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
    scenario::HandTool held =
        scenario::build_hand_tool(name, definition, scenario_.folder,
                                  scenario::why_no_contact(scenario_.dynamics, scenario_.contact));
    if (pose && !cutting::traits_of(held.shape).has_pose)
        throw InputError("tool '" + name + "': a suture has no pose: its points are in the tissue");
    const bool is_cut = cutting::traits_of(held.shape).is_at_once;
    if (pose && is_cut)
        throw InputError("tool '" + name +
                         "': a cut has no pose: it lies in the frame of the world");
    const sim::ToolId tool = world_.add_tool({name, std::move(held.shape)});
    note_tools();
    add_warnings(held.warnings);
    if (pose || is_cut) world_.place_tool(tool, pose.value_or(Pose()));
    if (is_cut) player_.targets().withdraw(tool);  // after it has cut in the next step
    return tool;
}

/// Returns the id that a tool has now: a restore gives it another one.
sim::ToolId WorldDriver::present(sim::ToolId tool) const { return world_.tools()[tool.index]; }

std::optional<Pose> WorldDriver::tool_pose(sim::ToolId tool) const {
    const sim::ToolInput* target = player_.targets().find(present(tool));
    if (target && target->pose) return target->pose;
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
    player_.targets().move(present(tool), pose);
}

void WorldDriver::place_tool(sim::ToolId tool, const Pose& pose) {
    require_posable(tool, pose);
    world_.place_tool(tool, pose);
    player_.targets().forget(present(tool));
}

void WorldDriver::withdraw_tool(sim::ToolId tool) {
    require_led(tool);
    const sim::ToolDef& def = world_.tool(tool);
    if (!cutting::traits_of(def.shape).has_pose)
        throw InputError("tool '" + def.name + "' is a suture: use untie()");
    if (!tool_pose(tool)) throw InputError("tool '" + def.name + "' is not there to be withdrawn");
    player_.targets().withdraw(present(tool));
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
    player_.targets().forget(present(tool));
    return num_points;
}

void WorldDriver::untie(sim::ToolId tool) {
    require_led(tool);
    world_.untie_suture(tool);
    player_.targets().forget(present(tool));
}

void WorldDriver::set_suture_target(sim::ToolId tool, double length) {
    require_led(tool);
    world_.require_possible(sim::StepInputs().draw(tool, length));
    player_.targets().draw(present(tool), length);
}

bool WorldDriver::is_in_tissue(sim::ToolId tool) const {
    const auto& states = world_.report().tools;
    const auto found = std::ranges::find(states, tool, &sim::ToolState::tool);
    return found != states.end() && found->is_in_tissue;
}

// --- Constraints and loads

sim::ConstraintId WorldDriver::constraint(const std::string& name) const {
    for (std::size_t i = 0; i < world_.model().boundary().constraints().size(); ++i)
        if (world_.model().boundary().constraints().name(i) == name) return world_.constraints()[i];
    throw InputError("the world has no constraint '" + name + "'");
}

void WorldDriver::require_new_constraint(const std::string& what, const std::string& name) const {
    require_name(what, name);
    const auto& all = world_.model().boundary().constraints().all();
    if (std::ranges::find(all, name, &physics::Constraint::name) != all.end())
        throw InputError(what + " '" + name + "': the world has a constraint of this name already");
}

void WorldDriver::add_constraint(const std::string& name, const scenario::Value& definition) {
    require_new_constraint("constraint", name);
    std::vector<std::string> warnings;
    const physics::Constraint built =
        scenario::build_added_constraint(definition, name, world_.mesh(), warnings);
    world_.add_constraint(built);
    add_warnings(warnings);
    warn_of_jump(built);
}

void WorldDriver::set_constraint(const std::string& name, const scenario::Value& definition) {
    const sim::ConstraintId id = constraint(name);
    std::vector<std::string> warnings;
    const physics::Constraint built =
        scenario::build_added_constraint(definition, name, world_.mesh(), warnings);
    world_.set_constraint(id, built);
    add_warnings(warnings);
    warn_of_jump(built);
}

/// Warns of a constraint that prescribes other positions than those that its nodes have.
void WorldDriver::warn_of_jump(const physics::Constraint& constraint) {
    constexpr double small = 0.05;  // of an element
    const double t = world_.time();
    const auto& [angles, displacements] = std::tie(constraint.angle, constraint.displacement);
    const double angle = angles.is_empty() ? 0.0 : angles.at(t);
    const Vec3 by = displacements.is_empty() ? Vec3(Vec3::Zero()) : displacements.at(t);
    const Eigen::AngleAxisd turn(angle, constraint.axis);
    double jump = 0.0;
    for (const auto& member : constraint.nodes.members()) {
        const Vec3& rest = world_.mesh().rest_position(member.node);
        const Vec3 target = constraint.point + turn * (rest - constraint.point) + by;
        Vec3 way = target - world_.positions()[member.node.index()];
        for (int i = 0; i < 3; ++i)
            if (!constraint.components[static_cast<std::size_t>(i)]) way[i] = 0.0;
        jump = std::max(jump, way.norm());
    }
    if (jump > small * topology::mean_element_length(world_.mesh()))
        warnings_.push_back("constraint '" + constraint.name + "' moves nodes by up to " +
                            format_number(jump) +
                            " m in the next step: it prescribes where they are relative to their "
                            "positions at rest; grasp() holds nodes where they are");
}

void WorldDriver::add_load(const std::string& name, const scenario::Value& definition) {
    require_name("load", name);
    const auto& all = world_.model().boundary().loads().all();
    if (std::ranges::find(all, name, &physics::Load::name) != all.end())
        throw InputError("load '" + name + "': the world has a load of this name already");
    std::vector<std::string> warnings;
    world_.add_load(scenario::build_added_load(definition, name, world_.mesh(), warnings));
    add_warnings(warnings);
}

void WorldDriver::set_load(const std::string& name, const scenario::Value& definition) {
    const sim::LoadId id = load(name);
    std::vector<std::string> warnings;
    world_.set_load(id, scenario::build_added_load(definition, name, world_.mesh(), warnings));
    add_warnings(warnings);
}

void WorldDriver::remove_load(const std::string& name) { world_.remove_load(load(name)); }

void WorldDriver::set_material(const scenario::Value& definition) {
    std::vector<std::string> warnings;
    const auto [material, regions, fibre] = scenario::build_added_material(definition, warnings);
    world_.set_material(material, regions, fibre);
    run_warnings_.follow_material(world_);
    add_warnings(warnings);
}

void WorldDriver::grasp(const std::string& name, std::vector<VertexId> nodes, const Pose& pose) {
    require_new_constraint("grasp", name);
    world_.grasp(name, std::move(nodes), pose);
}

void WorldDriver::set_grasp_target(const std::string& name, const Pose& pose) {
    const sim::ConstraintId id = constraint(name);
    if (!world_.grasp_pose(id))
        throw InputError(
            "constraint '" + name +
            "' is no grasp: it moves as its definition says; change() gives it another one");
    require_sound("grasp '" + name + "'", pose);
    player_.targets().move(id, pose);
}

std::optional<Pose> WorldDriver::grasp_pose(const std::string& name) const {
    const sim::ConstraintId id = constraint(name);
    const sim::GraspInput* target = player_.targets().find(id);
    return target ? target->pose : world_.grasp_pose(id);
}

void WorldDriver::release(const std::string& name) {
    const sim::ConstraintId id = constraint(name);
    player_.targets().forget(id);
    world_.release(id);
}

sim::LoadId WorldDriver::load(const std::string& name) const {
    const auto& all = world_.model().boundary().loads().all();
    const auto found = std::ranges::find(all, name, &physics::Load::name);
    if (found == all.end()) throw InputError("the world has no load '" + name + "'");
    return world_.loads()[static_cast<std::size_t>(found - all.begin())];
}

double WorldDriver::load_factor(const std::string& name) const {
    load(name);
    const auto& all = world_.model().boundary().loads().all();
    const auto& curve = std::ranges::find(all, name, &physics::Load::name)->factor;
    return curve.is_empty() ? 1.0 : curve.at(world_.time());
}

void WorldDriver::set_load_factor(const std::string& name, double factor) {
    world_.set_load_factor(load(name), factor);
}

}  // namespace incise::python
