// The exact cut of a tool with a sharp edge, from step to step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "incise/cutting/cutter.h"
#include "incise/sim/tools/tool_actor.h"

namespace incise::sim {

/// What an edge cuts as it moves. The owner sets `before` and `after`, m, with the same number of
/// points, and then splits or separates.
class EdgeCut {
  public:
    std::vector<Vec3> before, after;  ///< the edge, before and after the motion of a step

    void begin(cutting::Cutter& cutter, double snap) { cut_ = cutter.begin_cut(snap); }
    bool is_in_tissue(const cutting::Cutter& cutter) const {
        return cut_ && cutter.is_in_tissue(*cut_);
    }
    /// Divides the cells that the edge has swept.
    /// @pre  begin()
    cutting::Split split(const Tissue& tissue) {
        motion_.resize(after.size(), Vec3::Zero());
        if (before != after) find_motion();
        return tissue.cutter.split(*cut_, tissue.mesh, before, after);
    }
    /// Ends the cut where the edge is. split() may begin it again.
    cutting::Split end(const Tissue& tissue) {
        const cutting::BladeEnd blade(after, motion_);
        return tissue.cutter.end_cut(*cut_, tissue.mesh, tissue.model.fragments(), blade);
    }
    /// Takes the way from `before` as the direction of the last motion.
    void find_motion() {
        for (std::size_t i = 0; i < motion_.size(); ++i) motion_[i] = after[i] - before[i];
    }

    void save(ArchiveWriter& ar) const { ar(cut_, motion_); }
    /// Returns false if what was saved cannot be the cut of such an edge.
    /// @param splits      begin() was called
    /// @param num_points  of the edge
    bool restore(ArchiveReader& ar, const cutting::Cutter& cutter, bool splits,
                 std::size_t num_points) {
        ar(cut_, motion_);
        return cut_.has_value() == splits && (!cut_ || cutter.has_cut(*cut_)) &&
               (motion_.empty() || motion_.size() == num_points) &&
               std::ranges::all_of(motion_, [](const Vec3& v) { return v.allFinite(); });
    }

  private:
    std::optional<cutting::CutId> cut_;
    std::vector<Vec3> motion_;  // the last one, m
};

}  // namespace incise::sim
