// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/live/session.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "incise/base/archive.h"
#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/cutting/tools/probe_shape.h"
#include "incise/scenario/body.h"
#include "incise/scenario/tools/tool_kind.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::live {

namespace {

scenario::Scenario for_ticks(scenario::Scenario scenario, double tick, std::uint64_t num_ticks) {
    if (!(tick > 0.0 && tick < std::numeric_limits<double>::infinity()))
        throw InputError("a tick of " + std::to_string(tick) +
                         " s is not allowed: must be above 0");
    const bool has_end = num_ticks < std::numeric_limits<std::uint64_t>::max();
    scenario.dynamics.end_time =
        has_end ? static_cast<double>(num_ticks) * tick : std::numeric_limits<double>::infinity();
    return scenario;
}

/// Load steps are ticks. Other steps divide the tick evenly.
double steps_of_tick(const runner::StepSituation& situation) {
    if (situation.scenario.dynamics.mode == scenario::Mode::statics) return situation.stop;
    return runner::even_steps(situation);
}

runner::Simulation build(const scenario::Scenario& scenario,
                         const std::function<void(const std::string&)>& tell) {
    if (tell) tell("Reading the mesh, and choosing what is held and loaded");
    scenario::Body body = scenario::build_body(scenario);
    if (tell)
        tell("Building the body of " + std::to_string(body.mesh.num_elements()) + " elements");
    return {scenario, std::move(body), steps_of_tick};
}

bool is_suture(const LedTool& tool) { return tool.kind == "suture"; }

}  // namespace

Session::Session(scenario::Scenario scenario, double tick, std::uint64_t num_ticks,
                 const std::function<void(const std::string&)>& tell)
    : tick_(tick),
      last_tick_(num_ticks),
      simulation_(build(for_ticks(std::move(scenario), tick, num_ticks), tell)),
      why_no_contact_(scenario::why_no_contact(simulation_.scenario().dynamics,
                                               simulation_.scenario().contact)),
      element_size_(topology::mean_element_length(simulation_.mesh())) {
    for (const VertexId n : simulation_.mesh().nodes())
        box_.extend(simulation_.mesh().rest_position(n));
    ArchiveWriter state;
    simulation_.save(state);
    start_ = state.take();
}

const LedTool* Session::find(const std::string& name) const {
    const auto found = std::ranges::find(tools_, name, &LedTool::name);
    return found == tools_.end() ? nullptr : &*found;
}

LedTool& Session::tool(const std::string& name) {
    const auto found = std::ranges::find(tools_, name, &LedTool::name);
    if (found == tools_.end())
        throw InputError("there is no tool '" + name + "' that a hand leads");
    return *found;
}

LedTool& Session::tool_in_hand(const std::string& name) {
    LedTool& found = tool(name);
    if (!found.is_in_hand) throw InputError("tool '" + name + "' is not in the hand any more");
    return found;
}

// What is larger or farther than so many bodies is a slip, or meant to harm. Cuts are exact only
// among numbers of like size.
constexpr double most_bodies = 1000.0;

void Session::require_within_reach(const Pose& pose) const {
    require_sound(pose);
    if (!((pose.position - box_.center()).norm() <= most_bodies * box_.diagonal().norm()))
        throw InputError(
            "the tool would be more than 1000 times the size of the body away from it");
}

void Session::require_sensible(double length) const {
    if (!(std::abs(length) <= most_bodies * box_.diagonal().norm()))
        throw InputError("the tool is more than 1000 times as large as the body, or as far away");
}

void Session::require_sensible(const scenario::Value& value) const {
    if (const auto* number = value.get<double>()) require_sensible(*number);
    if (const auto* number = value.get<std::int64_t>())
        require_sensible(static_cast<double>(*number));
    if (const auto* array = value.get<scenario::Array>())
        for (const scenario::Value& item : *array) require_sensible(item);
}

/// Tools that touch pass through nothing, and the world divides a step for that: more than 1000
/// parts it refuses. A tick has at least one step.
void Session::require_near(const cutting::ToolShape& shape, const Pose& from,
                           const Pose& to) const {
    if (cutting::traits_of(shape).cuts) return;
    constexpr double part = 0.25, most_parts = 900.0;  // of an element, or of the probe
    double move = (to.position - from.position).norm(), size = element_size_;
    if (const auto* probe = std::get_if<cutting::Probe>(&shape)) {
        move += cutting::reach_of(probe->shape) * from.rotation.angularDistance(to.rotation);
        size = std::min(size, cutting::half_width_of(probe->shape));
    }
    if (!(move <= most_parts * part * size))
        throw InputError("a tool that touches tissue goes at most " +
                         format_number(most_parts * part * size) + " m in a tick, and not " +
                         format_number(move) + " m: move it more slowly");
}

std::vector<std::string> Session::execute(const Order& order) {
    sim::World& world = simulation_.world();
    std::vector<std::string> warnings;
    std::visit(
        [&](const auto& it) {
            using T = std::decay_t<decltype(it)>;
            if constexpr (std::is_same_v<T, AddTool>) {
                warnings = add(it);
            } else if constexpr (std::is_same_v<T, MoveTool>) {
                move(it);
            } else if constexpr (std::is_same_v<T, WithdrawTool>) {
                LedTool& withdrawn = tool_in_hand(it.name);
                if (is_suture(withdrawn))
                    throw InputError("suture '" + it.name + "' is untied, not withdrawn");
                withdrawn.is_to_be_withdrawn = true;
            } else if constexpr (std::is_same_v<T, CloseTool>) {
                const sim::ToolId id = tool_in_hand(it.name).id;
                if (world.close_tool(id) == 0 && cutting::traits_of(world.tool(id).shape).holds)
                    warnings.push_back("grasper '" + it.name + "' closes on nothing");
            } else if constexpr (std::is_same_v<T, OpenTool>) {
                world.open_tool(tool_in_hand(it.name).id);
            } else if constexpr (std::is_same_v<T, DrawSuture>) {
                LedTool& thread = tool(it.name);
                world.require_possible(sim::StepInputs().draw(thread.id, it.length));
                thread.length = it.length;
            } else {
                world.untie_suture(tool(it.name).id);
            }
        },
        order);
    orders_.push_back(order);
    return warnings;
}

scenario::HandTool Session::checked(const AddTool& order) const {
    const sim::World& world = simulation_.world();
    if (order.name.empty()) throw InputError("a tool needs a name");
    if (world.find_tool(order.name))
        throw InputError("there is a tool '" + order.name + "' already");
    require_within_reach(order.pose);
    if (const auto* definition = order.definition.get<scenario::Table>())
        if (const scenario::Value* points = scenario::find(*definition, "points"))
            require_sensible(*points);
    scenario::HandTool built = scenario::build_hand_tool(
        order.name, order.definition, simulation_.scenario().folder, why_no_contact_);
    if (const auto extent = scenario::kind_of(built.shape).extent(built.shape)) {
        require_sensible(extent->radius);
        for (const Vec3& x : extent->points)
            for (int i = 0; i < 3; ++i) require_sensible(x[i]);
    }
    if (cutting::traits_of(built.shape).is_at_once)
        throw InputError("a cut is not led by hand: take a blade");
    return built;
}

std::vector<std::string> Session::add(const AddTool& order) {
    scenario::HandTool built = checked(order);
    sim::World& world = simulation_.world();
    LedTool tool{.name = order.name,
                 .kind = std::move(built.kind),
                 .definition = order.definition,
                 .id = world.add_tool({order.name, std::move(built.shape)}),
                 .pose = order.pose};
    if (!is_suture(tool)) {
        world.place_tool(tool.id, tool.pose);
    } else if (world.tie_suture(tool.id) < 2) {
        built.warnings.push_back("suture '" + order.name +
                                 "' meets tissue at less than two of its "
                                 "points: it holds nothing");
    }
    if (is_suture(tool)) tool.length = world.suture_length(tool.id);
    tools_.push_back(std::move(tool));
    return std::move(built.warnings);
}

void Session::move(const MoveTool& order) {
    LedTool& moved = tool_in_hand(order.name);
    require_within_reach(order.pose);
    if (is_suture(moved)) throw InputError("suture '" + order.name + "' is drawn, not moved");
    const sim::World& world = simulation_.world();
    require_near(world.tool(moved.id).shape, world.tool_pose(moved.id), order.pose);
    moved.pose = order.pose;
}

bool Session::tick(const std::function<bool()>& is_to_stop) {
    const double begin = world().time(), end = static_cast<double>(num_ticks_ + 1) * tick_;
    set_targets();
    player_.begin(world());
    while (world().time() < end) {
        const auto step = simulation_.next_step(end);
        simulation_.step(step, player_.inputs((step.to - begin) / (end - begin), step.to >= end));
        player_.add(world().report());
        if (is_to_stop && world().time() < end && is_to_stop()) return false;
    }
    player_.end();
    for (LedTool& tool : tools_)
        if (tool.is_to_be_withdrawn) tool.is_in_hand = tool.is_to_be_withdrawn = false;
    ++num_ticks_;
    last_orders_ = std::exchange(orders_, {});
    return true;
}

/// Tells the player where the tools are to be at the end of the tick.
void Session::set_targets() {
    sim::StepInputs& targets = player_.targets();
    targets.clear();
    for (const LedTool& tool : tools_) {
        if (!tool.is_in_hand) continue;
        if (!is_suture(tool)) {
            targets.move(tool.id, tool.pose);
            if (tool.is_to_be_withdrawn) targets.withdraw(tool.id);
        } else if (world().is_suture_tied(tool.id)) {
            targets.draw(tool.id, tool.length);
        }
    }
}

Session::UndoPoint Session::undo_point() const {
    return {num_ticks_, simulation_.undo_point(), tools_, orders_};
}

void Session::undo(const UndoPoint& point) {
    simulation_.undo(point.state);
    num_ticks_ = point.num_ticks;
    tools_ = point.tools;
    orders_ = point.orders;
    last_orders_.clear();
    player_ = {};
}

void Session::reset() {
    ArchiveReader state(start_);
    simulation_.restore(state);
    num_ticks_ = 0;
    tools_.clear();
    orders_.clear();
    last_orders_.clear();
    player_ = {};
}

std::uint64_t Session::checksum() const {
    std::uint64_t sum = num_ticks_;
    const auto mix = [&](double value) {
        sum = (std::rotl(sum, 29) ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15u;
    };
    const auto positions = world().positions(), velocities = world().velocities();
    for (const VertexId n : world().mesh().nodes())
        for (int i = 0; i < 3; ++i) {
            mix(positions[n.index()][i]);
            mix(velocities[n.index()][i]);
        }
    return sum;
}

}  // namespace incise::live
