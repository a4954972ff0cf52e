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
    is_first_ = true;
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

const StepInputs& ToolPlayer::inputs(double part, bool is_last) {
    inputs_.clear();
    for (std::size_t i = 0; i < tools_.size(); ++i) {
        const ToolInput& target = targets_.tools()[i];
        const auto& [pose, length, is_at_once] = tools_[i];
        const bool is_over = is_at_once && target.is_withdrawn && !is_first_;
        if (target.pose && !is_over)
            inputs_.move(target.tool,
                         is_last || !pose ? *target.pose : interpolate(*pose, *target.pose, part));
        if (target.length)
            inputs_.draw(target.tool,
                         is_last ? *target.length : std::lerp(length, *target.length, part));
        if (target.is_withdrawn && (is_at_once ? is_first_ : is_last))
            inputs_.withdraw(target.tool,
                             target.pose_before_end ? &*target.pose_before_end : nullptr);
    }
    for (std::size_t i = 0; i < grasps_.size(); ++i) {
        const GraspInput& target = targets_.grasps()[i];
        inputs_.move(target.grasp,
                     is_last ? target.pose : interpolate(grasps_[i], target.pose, part));
    }
    is_first_ = false;
    return inputs_;
}

void ToolPlayer::restore(const StepInputs& saved, const World& world) {
    // An archive does not have the number of the world in its ids.
    const auto known = [](auto ids, const auto& id) {
        const auto found = std::ranges::find(ids, id);
        if (found == ids.end())
            throw InputError("its tools or constraints are not those of its world");
        return *found;
    };
    StepInputs targets;
    for (ToolInput input : saved.tools()) {
        input.tool = known(world.tools(), input.tool);
        targets.add(input);
    }
    for (const GraspInput& input : saved.grasps())
        targets.move(known(world.constraints(), input.grasp), input.pose);
    world.require_possible(targets);
    targets_ = std::move(targets);
    forces_.begin(world.time());
}

}  // namespace incise::sim
