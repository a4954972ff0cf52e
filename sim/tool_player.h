// Leads tools and grasps through an interval of several steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "incise/base/archive.h"
#include "incise/sim/step_inputs.h"
#include "incise/sim/tool_forces.h"
#include "incise/topology/pose.h"

namespace incise::sim {

class World;

/// Leads tools and grasps of a world from where they are to their targets, through an interval of
/// several steps: a tick of a live session, or a call from Python. It also gives the mean of what
/// tissue exerts on the tools in the interval. Steps take no memory.
///
///     player.targets().move(knife, pose);
///     player.begin(world);
///     for (int i = 1; i <= n; ++i)
///         player.add(world.step(dt, player.inputs(double(i) / n, i == n)));
///     player.end();
class ToolPlayer {
  public:
    /// Returns what is to be at the end of the next interval.
    StepInputs& targets() { return targets_; }
    const StepInputs& targets() const { return targets_; }

    /// Begins an interval at the present time of the world.
    void begin(const World& world);
    /// Returns the inputs of the next step. Tools go straight, and turn the shortest way; a thread
    /// is drawn evenly. A tool that was not there is at its target at once. Tools are withdrawn in
    /// the last step; those that cut at once, such as a plane, in the first.
    /// @param fraction     of the interval, at the end of the step
    /// @param is_last  true in the last step, which ends at the targets
    /// @lifetime       until the next call
    const StepInputs& inputs(double fraction, bool is_last);
    /// Adds a step, which had the last inputs(), to the means.
    void add(const StepReport& step);
    /// Ends the interval. Nothing has a target any more.
    void end() { targets_.clear(); }
    /// Returns the means over the interval so far, or over the last one.
    const ToolForces& forces() const { return forces_; }

    /// Writes the targets.
    void save(ArchiveWriter& ar) const { ar(targets_); }
    /// Takes the targets that save() has written, and forgets the means. Targets that cannot be in
    /// the world are left out.
    void restore(const StepInputs& saved, const World& world);

  private:
    /// Where a tool is at the beginning of the interval.
    struct Start {
        std::optional<Pose> pose;
        double length = 0.0;
        bool is_at_once = false;
    };

    StepInputs targets_, inputs_;
    std::vector<Start> tools_;  // by target
    std::vector<Pose> grasps_;  // by target
    ToolForces forces_;
};

}  // namespace incise::sim
