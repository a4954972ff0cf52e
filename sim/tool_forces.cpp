// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tool_forces.h"

#include <algorithm>

#include "incise/sim/world.h"

namespace incise::sim {

void ToolForces::begin(double time) {
    from_ = to_ = time;
    std::ranges::fill(sums_, Sum());
}

void ToolForces::add(const StepReport& step) {
    for (const ToolState& state : step.tools) {
        const std::size_t i = state.tool.index;
        if (i >= sums_.size()) sums_.resize(i + 1);
        sums_[i].impulse += (step.to - step.from) * state.force;
        sums_[i].angular_impulse += (step.to - step.from) * state.torque;
    }
    to_ = step.to;
}

ToolForces::Mean ToolForces::of(ToolId tool) const {
    if (tool.index >= sums_.size() || !(to_ > from_)) return {};
    const auto& [impulse, angular_impulse] = sums_[tool.index];
    return {impulse / (to_ - from_), angular_impulse / (to_ - from_)};
}

}  // namespace incise::sim
