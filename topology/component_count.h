// How many pieces a mesh has, edit after edit.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "incise/base/disjoint_set.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// The number of Components, without a look at the whole mesh for each edit.
class ComponentCount {
  public:
    /// Cost: that of components().
    explicit ComponentCount(const Mesh& mesh) : value_(components(mesh).count) {}

    int value() const { return value_; }

    /// Follows an edit of the mesh, which has not been edited since.
    /// Cost: a look at the elements round what it changed, as far as it takes to find that they
    /// still hang together; where they do not, at the smaller pieces, too.
    void apply(const Mesh& mesh, const ChangeSet& changes);

  private:
    /// Which of the touched elements, by their places in the list, have hung together all the time,
    /// as far as it takes to count pieces. `found` receives the others that it came through.
    DisjointSet search(const Mesh& mesh, const ChangeSet& changes,
                       const std::vector<ElementId>& touched, std::vector<ElementId>& found);
    std::int32_t& group_of(ElementId e) { return group_of_[e.index()]; }

    int value_;
    std::vector<std::int32_t> group_of_;  // by element; -1 between edits: kept for its memory only
};

}  // namespace incise::topology
