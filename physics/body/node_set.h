// A selection of nodes that follows the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A node born between members is one itself; one between a member and another node is none.
/// Members that die stay listed, so that an undone edit finds them again: ask the mesh who is
/// alive.
class NodeSet {
  public:
    struct Member {
        NodeId node;
        /// The member of the first selection that it is, or is a copy of; invalid for one born
        /// between others and for its copies.
        NodeId origin;
        static void archive(auto& ar, auto& self) { ar(self.node, self.origin); }
    };

    NodeSet() = default;
    NodeSet(std::vector<NodeId> nodes);

    /// In ascending order of nodes.
    const std::vector<Member>& members() const { return members_; }
    /// Null for a node that is no member.
    const Member* find(NodeId n) const;
    bool contains(NodeId n) const { return find(n) != nullptr; }

    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member is no node of the mesh.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<Member> members_;
};

}  // namespace incise::physics
