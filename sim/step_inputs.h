// What leads tools and grasps in a step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "incise/sim/handles.h"
#include "incise/topology/pose.h"

namespace incise::sim {

/// What a tool is to do in a step.
struct ToolInput {
    ToolId tool;
    std::optional<Pose> pose = {};             ///< at the end of the step
    std::optional<double> length = {};         ///< of a thread without tension, at the end, m
    bool is_withdrawn = false;                 ///< at the end of the step
    std::optional<Pose> pose_before_end = {};  ///< see StepInputs::withdraw()
    static void archive(auto& ar, auto& self) {
        ar(self.tool, self.pose, self.length, self.is_withdrawn, self.pose_before_end);
    }
};

/// Where a grasp is to be at the end of a step.
struct GraspInput {
    ConstraintId grasp;
    Pose pose;
    static void archive(auto& ar, auto& self) { ar(self.grasp, self.pose); }
};

/// What leads tools and grasps in a step of a World: an argument of World::step(). Tools and grasps
/// that are not named stay where they are.
///
///     world.step(dt, StepInputs().move(knife, pose));
///
/// The step checks the values. A step that is refused has changed nothing.
/// Cost: proportional to the number of tools that are named.
class StepInputs {
  public:
    /// Sets the pose of a tool at the end of the step, m. The tool goes there straight and by the
    /// shortest turn. A tool that is not there appears at this pose.
    StepInputs& move(ToolId tool, const Pose& pose);
    /// Sets the pose of the frame of a grasp at the end of the step, m.
    StepInputs& move(ConstraintId grasp, const Pose& pose);
    /// Sets the length that the thread of a tied suture has without tension at the end of the step,
    /// m. It gets there evenly.
    StepInputs& draw(ToolId suture, double length);
    /// Withdraws a tool at the end of the step. The tool still takes part in the step, and its cut
    /// ends at the position that the blade then has. In a later step, a pose makes the tool present
    /// again.
    /// @param pose_before  a pose shortly before the last one. The two poses give the direction in
    ///                     which the blade moved. If null, the direction is that of the last step
    ///                     in which the blade moved.
    StepInputs& withdraw(ToolId tool, const Pose* pose_before = nullptr);
    /// Says all of a tool anew.
    StepInputs& add(const ToolInput& input);
    /// Forgets all, and keeps the memory.
    void clear();

    std::span<const ToolInput> tools() const { return tools_; }
    std::span<const GraspInput> grasps() const { return grasps_; }
    /// Returns what a tool is to do, or null. An id from before a restore of the world is another
    /// one than that of now: a step refuses both together.
    /// @lifetime  until the inputs change
    const ToolInput* find(ToolId tool) const;
    const GraspInput* find(ConstraintId grasp) const;
    /// Forgets what was said of a tool or a grasp.
    void forget(ToolId tool);
    void forget(ConstraintId grasp);

    static void archive(auto& ar, auto& self) { ar(self.tools_, self.grasps_); }

  private:
    ToolInput& of(ToolId tool);

    std::vector<ToolInput> tools_;
    std::vector<GraspInput> grasps_;
};

}  // namespace incise::sim
