// Finds where a cut in progress ends inside the body, and which nodes of its front are finished.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Returns the position of a node after the step, m.
using PositionOf = std::function<Vec3(VertexId)>;

/// Forgets the nodes of the front round which the cut is finished. A later intersection there is
/// part of another cut.
///
/// Nodes near the boundary at which the sweep has ended stay, since the cut may go on there. They
/// are within the eight rings of elements round the boundary. The number of intersections round a
/// triangle that the boundary passes through is odd. If it is odd but the blade is elsewhere, the
/// blade has ended in the body and left.
///
/// Such a search examines the whole front, so it takes place in three cases only:
/// - More than half of the front's nodes are new.
/// - The sweep crosses nothing any more, but the front has changed.
/// - The sweep crosses nothing any more, and the blade is far away.
///
/// @param mesh         after the edit
/// @param surface      what the cut follows
/// @param position     of nodes, copies included
/// @param has_crossed  whether the surface passed through any element in this step
/// @param front        of the cut
/// Cost: for each search, proportional to the number of elements at the front. In addition it
/// clears six bytes for each node of the mesh and one bit for each element.
void leave_behind(const topology::Mesh& mesh, const CutSurface& surface, const PositionOf& position,
                  bool has_crossed, CutFront& front);

}  // namespace incise::cutting
