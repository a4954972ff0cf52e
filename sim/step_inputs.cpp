// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/step_inputs.h"

#include <algorithm>
#include <type_traits>

namespace incise::sim {

namespace {

/// Finds a thing by its id. Another world may have a thing with the same index.
template <class Id>
auto find_in(auto& list, Id(std::remove_cvref_t<decltype(list.front())>::*member), const Id& id) {
    return std::ranges::find_if(list, [&](const auto& input) {
        return input.*member == id && (input.*member).world == id.world;
    });
}

}  // namespace

ToolInput& StepInputs::of(ToolId tool) {
    const auto found = find_in(tools_, &ToolInput::tool, tool);
    return found == tools_.end() ? tools_.emplace_back(ToolInput{tool}) : *found;
}

StepInputs& StepInputs::move(ToolId tool, const Pose& pose) {
    of(tool).pose = pose;
    return *this;
}

StepInputs& StepInputs::move(ConstraintId grasp, const Pose& pose) {
    const auto found = find_in(grasps_, &GraspInput::grasp, grasp);
    if (found == grasps_.end())
        grasps_.push_back({grasp, pose});
    else
        found->pose = pose;
    return *this;
}

StepInputs& StepInputs::draw(ToolId suture, double length) {
    of(suture).length = length;
    return *this;
}

StepInputs& StepInputs::withdraw(ToolId tool, const Pose* pose_before) {
    ToolInput& input = of(tool);
    input.is_withdrawn = true;
    input.pose_before_end.reset();
    if (pose_before) input.pose_before_end = *pose_before;
    return *this;
}

StepInputs& StepInputs::add(const ToolInput& input) {
    of(input.tool) = input;
    return *this;
}

void StepInputs::clear() {
    tools_.clear();
    grasps_.clear();
}

const ToolInput* StepInputs::find(ToolId tool) const {
    const auto found = find_in(tools_, &ToolInput::tool, tool);
    return found == tools_.end() ? nullptr : &*found;
}

const GraspInput* StepInputs::find(ConstraintId grasp) const {
    const auto found = find_in(grasps_, &GraspInput::grasp, grasp);
    return found == grasps_.end() ? nullptr : &*found;
}

void StepInputs::forget(ToolId tool) {
    const auto found = find_in(tools_, &ToolInput::tool, tool);
    if (found != tools_.end()) tools_.erase(found);
}

void StepInputs::forget(ConstraintId grasp) {
    const auto found = find_in(grasps_, &GraspInput::grasp, grasp);
    if (found != grasps_.end()) grasps_.erase(found);
}

}  // namespace incise::sim
