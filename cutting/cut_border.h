// Where a cut that goes on ends inside the body, and which nodes of its front are done with.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <unordered_set>
#include <vector>

#include "cutting/cut_front.h"
#include "topology/mesh.h"

namespace incise::cutting {

/// The elements that the border of a cut runs through, by their nodes, as the counts of crossings
/// tell: round a triangle through which it runs they are odd in number, and only there.
class CutBorder {
  public:
    /// @param snaps  whether nodes may come to count as on the cut from an element farther away:
    ///               then the elements beside those of the border belong to it too
    /// Cost: proportional to the stars of the nodes of the front.
    CutBorder(const topology::Mesh& mesh, const CutFront& front, bool snaps);

    /// Whether the node has an element with a node of the border: the cut may go on there.
    bool is_beside(topology::NodeId n);

  private:
    const topology::Mesh& mesh_;
    std::unordered_set<std::int32_t> nodes_;
    std::vector<topology::ElementId> star_;  // scratch
};

/// Forgets nodes round which the cut is finished. Each comes to be on the side of those of its
/// neighbours that are not on the cut: no edge to them is crossed then, and the counts of its other
/// edges stay true.
void forget(const topology::Mesh& mesh, const std::vector<topology::NodeId>& nodes,
            CutFront& front);

}  // namespace incise::cutting
