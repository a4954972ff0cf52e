// A tool of the scenario in motion: where it is when, and what it plans to cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "cutting/cut_plan.h"
#include "cutting/pose.h"
#include "cutting/tissue_motion.h"
#include "sim/scenario.h"

namespace incise::sim {

/// Follows its path: position linear between keys, orientation along the shortest turn.
class Tool {
  public:
    explicit Tool(const ToolSpec& spec) : spec_(spec) {}

    const std::string& name() const { return spec_.name; }
    cutting::Pose pose(double time) const;
    /// Whether it is there at some moment of the interval: from its first to its last key.
    bool is_present(double from, double to) const {
        return to > spec_.path.front().time && from < spec_.path.back().time;
    }
    /// What it cuts while it and the tissue move in [from, to]. Touches nothing.
    cutting::CutPlan plan(const cutting::TissueMotion& tissue, double from, double to) const;

  private:
    ToolSpec spec_;
};

}  // namespace incise::sim
