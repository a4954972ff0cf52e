// The number of connected components of a mesh, updated after each edit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "incise/base/disjoint_set.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// The number of connected components (see Components), updated without a search of the whole mesh.
class ComponentCount {
  public:
    /// Counts the components of `mesh`. Cost: that of components().
    explicit ComponentCount(const Mesh& mesh) : value_(num_components(mesh)), epoch_(mesh) {}

    int value() const { return value_; }

    /// Follows an edit of the mesh.
    /// @param mesh     the mesh after the edit; it has not been edited since
    /// @param changes  the edit
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// Cost: a search round the changed elements, which ends when they are found to be connected.
    /// Where they are not connected, the search also covers the smaller components.
    void apply(const Mesh& mesh, const ChangeSet& changes);

    /// Goes to a state of the mesh of which the number is known.
    void restore(const Mesh& mesh, int value) {
        value_ = value;
        epoch_ = FollowedEpoch(mesh);
    }

  private:
    /// Returns sets of those touched elements, by their index in `touched`, that are connected by
    /// faces which the edit did not change. The search ends when the components can be counted.
    /// `found` receives the other elements that the search has visited.
    DisjointSet search(const Mesh& mesh, const ChangeSet& changes,
                       const std::vector<CellId>& touched, std::vector<CellId>& found);
    std::int32_t& group_of(CellId e) { return group_of_[e.index()]; }

    int value_;
    std::vector<std::int32_t> group_of_;  // by element; scratch memory, all -1 between edits
    FollowedEpoch epoch_;
};

}  // namespace incise::topology
