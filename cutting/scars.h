// Where earlier cuts passed by the nodes that counted as lying on them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <unordered_map>
#include <vector>

#include "topology/change_set.h"
#include "topology/types.h"

namespace incise::cutting {

/// A plane that passes by a node: that of a surface where it crosses an edge at the node.
struct NearPlane {
    Vec3 normal;    ///< of unit length
    double height;  ///< of the node above it, m
};

/// Nodes that counted as lying on a cut, and where it really was. A cut that passes by at the same
/// place counts them as on itself too: so a cut along an earlier one changes nothing, though that
/// one's nodes are only near it, and no other cut is drawn to them. Positions are the current ones:
/// once the body has moved, nothing is at the same place.
class Scars {
  public:
    void add(topology::NodeId n, const NearPlane& plane);
    /// @param size  of the elements there, m, which rounding is measured by
    bool has(topology::NodeId n, const NearPlane& plane, double size) const;
    /// Copies of a node are what it is.
    void follow(const topology::ChangeSet& changes);

  private:
    std::unordered_map<std::int32_t, std::vector<NearPlane>> planes_;
};

}  // namespace incise::cutting
