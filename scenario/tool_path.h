// The path of a tool of a scenario: its poses as a function of time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "incise/scenario/time_key.h"
#include "incise/topology/pose.h"

namespace incise::scenario {

/// A sequence of poses at given times. Between two of them the position is interpolated linearly,
/// the orientation along the shortest rotation.
///
/// Without keys, only keys() may be called.
class ToolPath {
  public:
    /// @param is_endless  true if the tool acts in all steps
    /// @pre  the times ascend strictly
    explicit ToolPath(std::vector<TimeKey<Pose>> keys, bool is_endless = false)
        : keys_(std::move(keys)), is_endless_(is_endless) {}

    /// Returns the pose at `time`, s. Before the first key it is the pose of the first key, after
    /// the last key that of the last.
    Pose pose(double time) const;

    /// True if the tool acts in the step (from, to], s. A tool acts in the steps that overlap the
    /// time between its first and its last key. A tool with one key acts in the step that contains
    /// the time of the key. The first step contains the time 0.
    bool is_present(double from, double to) const;

    double first_time() const { return keys_.front().time; }  ///< s
    /// Returns the time of the last key, s; infinite if the tool acts in all steps.
    double last_time() const {
        return is_endless_ ? std::numeric_limits<double>::infinity() : keys_.back().time;
    }

    /// Returns a pose shortly before the tool reaches its last pose. The two poses give the
    /// direction in which the tool moved. Returns nothing if the tool never moves.
    std::optional<Pose> pose_before_end() const;

    const std::vector<TimeKey<Pose>>& keys() const { return keys_; }

  private:
    std::vector<TimeKey<Pose>> keys_;
    bool is_endless_;
};

}  // namespace incise::scenario
