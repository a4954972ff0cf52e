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
    /// Whether it acts in the step (from, to], s: it is there from its first to its last key, a
    /// tool with one key in the step that contains it. The first step contains its start too.
    bool is_present(double from, double to) const;
    /// What it cuts while it and the tissue move in [from, to]. Touches nothing.
    cutting::CutPlan plan(const cutting::TissueMotion& tissue, double from, double to) const;

  private:
    ToolSpec spec_;
};

}  // namespace incise::sim
