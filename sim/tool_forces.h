// What tissue exerts on tools, as means over an interval.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "incise/base/types.h"
#include "incise/sim/handles.h"

namespace incise::sim {

struct StepReport;

/// What tissue exerts on tools: means over an interval of steps. All forces of tools that runs,
/// sessions and Python give are such means, each over the interval that its value stands for.
/// Docs: docs/contact.md, What a force means.
class ToolForces {
  public:
    /// @param time  when the interval begins, s
    explicit ToolForces(double time = 0.0) { begin(time); }
    /// Begins another interval.
    void begin(double time);
    /// Adds a step, with which the interval then ends.
    /// @pre  it begins where the interval ends
    void add(const StepReport& step);

    struct Mean {
        /// Force, N, and torque about the origin of the tool, N m, in the frame of the world.
        Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    };
    /// Returns the mean over the interval; zero before the first step.
    Mean of(ToolId tool) const;
    double from() const { return from_; }  ///< s
    double to() const { return to_; }      ///< s

    static void archive(auto& ar, auto& self) { ar(self.from_, self.to_, self.sums_); }

  private:
    struct Sum {
        Vec3 impulse = Vec3::Zero(), angular_impulse = Vec3::Zero();  // N s, N m s
        static void archive(auto& ar, auto& self) { ar(self.impulse, self.angular_impulse); }
    };
    double from_ = 0.0, to_ = 0.0;  // s
    std::vector<Sum> sums_;         // by index of the tools
};

}  // namespace incise::sim
