// A selection of nodes that follows the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "topology/change_set.h"
#include "topology/types.h"

namespace incise::physics {

/// A node born between members is one itself. Members that die stay listed, so that an undone
/// edit finds them again: ask the mesh who is alive.
class NodeSet {
  public:
    struct Member {
        topology::NodeId node;
        topology::NodeId origin;  ///< the member of the first selection that it is a copy of
    };

    explicit NodeSet(std::vector<topology::NodeId> nodes = {});

    /// In ascending order of nodes.
    const std::vector<Member>& members() const { return members_; }
    bool contains(topology::NodeId n) const { return find(n) != nullptr; }

    /// Returns whether the set or the stars of its members may have changed.
    bool apply(const topology::ChangeSet& changes);

  private:
    const Member* find(topology::NodeId n) const;
    std::vector<Member> members_;
};

}  // namespace incise::physics
