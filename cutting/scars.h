// How far the nodes of earlier cuts are off them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <unordered_map>

#include "topology/change_set.h"
#include "topology/types.h"

namespace incise::cutting {

/// Nodes that counted as lying on a cut, with their distance from it at rest. A later cut that
/// passes by no farther counts them as on itself too: a cut along an earlier one changes nothing,
/// though its nodes are only near it.
class Scars {
  public:
    /// Keeps the larger distance, m.
    void add(topology::NodeId n, double distance);
    /// Whether a surface at this distance, m, may be that of an earlier cut through the node.
    bool may_hold(topology::NodeId n, double distance) const;
    /// Copies of a node are what it is.
    void follow(const topology::ChangeSet& changes);

  private:
    std::unordered_map<std::int32_t, double> distances_;
};

}  // namespace incise::cutting
