// Where a cut that goes on ends inside the body, and which nodes of its front are done with.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "cutting/cut_front.h"
#include "topology/mesh.h"

namespace incise::cutting {

/// By node id, which nodes of the front are beside the border of the cut: the cut may go on there.
/// They have an element in common with a node of an element through which the border runs. The
/// counts of crossings tell which: round a triangle through which the border runs they are odd in
/// number, and only there. What it says of other nodes is of no meaning.
///
/// @param snaps  whether nodes may come to count as on the cut from an element farther away:
///               then the elements beside those of the border belong to it too
/// Cost: proportional to the number of elements at the front, and clearing five bytes for each node
/// of the mesh and a bit for each element.
std::vector<std::uint8_t> nodes_beside_border(const topology::Mesh& mesh, const CutFront& front,
                                              bool snaps);

/// Forgets nodes round which the cut is finished. Each comes to be on the side of those of its
/// neighbours that are not on the cut: no edge to them is crossed then, and the counts of its other
/// edges stay true.
void forget(const topology::Mesh& mesh, const std::vector<topology::NodeId>& nodes,
            CutFront& front);

}  // namespace incise::cutting
