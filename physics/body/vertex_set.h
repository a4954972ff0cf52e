// A selection of nodes that follows the mesh through edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A set of nodes. A new node becomes a member if all its sources are members: so a copy of a
/// member, and a node between members. Dead members stay in the set, so that an edit can be undone:
/// Mesh::is_alive tells which members are alive.
class VertexSet {
  public:
    struct Member {
        VertexId node;
        /// The node of the first selection that the member is, or of which it is a copy. Invalid
        /// for a node between others and for its copies.
        VertexId origin;
        static void archive(auto& ar, auto& self) { ar(self.node, self.origin); }
    };

    VertexSet() = default;
    VertexSet(std::vector<VertexId> vertices);

    /// Returns the members in ascending order of nodes.
    const std::vector<Member>& members() const { return members_; }
    /// Returns the member of a node; null if the node is no member.
    const Member* find(VertexId n) const;
    bool contains(VertexId n) const { return find(n) != nullptr; }

    /// Follows an edit; `mesh` is the mesh after the edit.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);

    /// Throws InputError if a member is no node of the mesh or if the members are not in strictly
    /// ascending order.
    void require_fit(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) { ar(self.members_); }

  private:
    std::vector<Member> members_;
};

}  // namespace incise::physics
