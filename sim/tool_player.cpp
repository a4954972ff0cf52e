// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tool_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "incise/base/error.h"
#include "incise/sim/world.h"

namespace incise::sim {

void ToolPlayer::begin(const World& world) {
    forces_.begin(world.time());
    tools_.clear();
    for (const ToolInput& target : targets_.tools()) {
        Start& start = tools_.emplace_back();
        if (world.is_tool_present(target.tool)) start.pose = world.tool_pose(target.tool);
        if (target.length) start.length = world.suture_length(target.tool);
        start.is_at_once = cutting::traits_of(world.tool(target.tool).shape).is_at_once;
    }
    grasps_.clear();
    for (const GraspInput& target : targets_.grasps())
        grasps_.push_back(world.grasp_pose(target.grasp).value_or(target.pose));
}

const StepInputs& ToolPlayer::inputs(double fraction, bool is_last) {
    inputs_.clear();
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        const ToolInput& target = targets_.tools()[i];
        const auto& [pose, length, is_at_once] = tools_[i];
        if (target.pose)
            inputs_.move(target.tool, is_last || !pose
                                          ? *target.pose
                                          : interpolate(*pose, *target.pose, fraction));
        if (target.length)
            inputs_.draw(target.tool,
                         is_last ? *target.length : std::lerp(length, *target.length, fraction));
        if (target.is_withdrawn && (is_at_once || is_last))
            inputs_.withdraw(target.tool,
                             target.pose_before_end ? &*target.pose_before_end : nullptr);
    }
    for (std::size_t i = 0; i < grasps_.size(); ++i) {
        const GraspInput& target = targets_.grasps()[i];
        inputs_.move(target.grasp,
                     is_last ? target.pose : interpolate(grasps_[i], target.pose, fraction));
    }
    return inputs_;
}

void ToolPlayer::add(const StepReport& step) {
    forces_.add(step);
    // What cuts at once has done so. An interval that is given up does not do it again.
    for (std::size_t i = tools_.size(); i-- > 0;) {
        const ToolInput& target = targets_.tools()[i];
        if (!tools_[i].is_at_once || !target.is_withdrawn) continue;
        targets_.forget(target.tool);
        tools_.erase(tools_.begin() + static_cast<std::ptrdiff_t>(i));
    }
}

void ToolPlayer::restore(const StepInputs& saved, const World& world) {
    targets_.clear();
    tools_.clear();
    grasps_.clear();
    forces_.begin(world.time());
    const auto is_possible = [&](const StepInputs& input) {
        try {
            world.require_possible(input);
            return true;
        } catch (const InputError&) {
            return false;
        }
    };
    // An archive does not have the number of the world in its ids.
    for (ToolInput input : saved.tools()) {
        const auto tool = std::ranges::find(world.tools(), input.tool);
        if (tool == world.tools().end()) continue;
        input.tool = *tool;
        if (is_possible(StepInputs().add(input))) targets_.add(input);
    }
    for (const GraspInput& input : saved.grasps()) {
        const auto grasp = std::ranges::find(world.constraints(), input.grasp);
        if (grasp != world.constraints().end() &&
            is_possible(StepInputs().move(*grasp, input.pose)))
            targets_.move(*grasp, input.pose);
    }
}

}  // namespace incise::sim
