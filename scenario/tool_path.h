// Where a tool is when: the path of a scenario's tool.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <vector>

#include "incise/scenario/time_key.h"
#include "incise/topology/pose.h"

namespace incise::scenario {

/// Keys of a pose. Between two keys the position is linear in time, and the orientation goes along
/// the shortest turn.
class ToolPath {
  public:
    /// @pre There is a key, and times ascend strictly.
    explicit ToolPath(std::vector<TimeKey<Pose>> keys) : keys_(std::move(keys)) {}

    /// The pose at `time`, s; that of the first key before it, and of the last after it.
    Pose pose(double time) const;

    /// True if the tool acts in the step (from, to], s: it is there from its first to its last key,
    /// a tool with one key in the step that contains the key. The first step contains its start.
    bool is_present(double from, double to) const;

    double first_time() const { return keys_.front().time; }  ///< s
    double last_time() const { return keys_.back().time; }    ///< s

    /// The pose a moment before the tool came to where it ends, which tells the direction in which
    /// it moved; nothing if it never moved.
    std::optional<Pose> pose_before_end() const;

    const std::vector<TimeKey<Pose>>& keys() const { return keys_; }

  private:
    std::vector<TimeKey<Pose>> keys_;
};

}  // namespace incise::scenario
