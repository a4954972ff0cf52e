// Where a cut that goes on ends inside the body, and which nodes of its front are done with.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Where a node is after the step, m.
using PositionOf = std::function<Vec3(NodeId)>;

/// Forgets the nodes of the front round which the cut is finished: a later intersection there is
/// another cut. Kept are those near the boundary at which the sweep has ended, as the cut may go on
/// there: they are a few elements away from one through which the boundary runs. The counts of
/// crossings tell which do: round a triangle through which the boundary runs they are odd in
/// number. Where they are odd but the blade is no more, it ended in the body and has gone.
///
/// To find this out takes a look at the whole front. So it is done when the front has grown by a
/// share of its size, and when the sweep crosses nothing any more but has done so, or is far away.
///
/// @param has_crossed  whether the surface passed through any element in this step
/// Cost of a look: proportional to the number of elements at the front, and clearing six bytes for
/// each node of the mesh and a bit for each element.
void leave_behind(const topology::Mesh& mesh, const CutSurface& surface, const PositionOf& position,
                  bool has_crossed, CutFront& front);

}  // namespace incise::cutting
