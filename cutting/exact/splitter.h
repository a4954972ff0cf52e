// The exact cut: divides elements along a surface and separates them there. See docs/cutting.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/exact/split.h"
#include "incise/cutting/exact/suspended_cut.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Divides the tetrahedra that the surface crosses and opens the faces on it, in one transaction.
///
/// Edges that the surface crosses are divided there, in the order in which the surface comes to
/// them. Of those that it meets at once, the longest comes first. A division makes two of every
/// element round the edge, so the mesh stays conforming and no volume is lost. Then the faces open
/// whose three nodes are on the surface and whose elements are on different sides of it.
///
/// A body that the surface passes right through comes apart. Where the surface ends, the opened
/// faces end within one element of it.
/// @param mesh          the mesh to cut
/// @param tissue        its motion in this step
/// @param surface       what the cut follows
/// @param front         the state of the cut so far if a blade goes on, else an empty one; is
///                      brought up to date
/// @param options       of the cut
/// @param snap_history  of all cuts of this body so far; is brought up to date
/// @param resting       the suspended cuts of other blades. Their fronts follow the divisions, but
///                      not yet the copies of nodes: see CutFront::apply(). Faces that come to lie
///                      on these cuts behind their blades open, too.
/// @pre  all elements are tetrahedra
/// Cost: a few microseconds for each crossed element, and the search. The search looks at what is
/// near the surface if `tissue` has boxes, else at all elements.
Split split(topology::Mesh& mesh, const TissueMotion& tissue, const CutSurface& surface,
            CutFront& front, const SplitOptions& options, SnapHistory& snap_history,
            std::span<SuspendedCut> resting = {});

/// Ends the cut of a blade at its edge, where its path ends. Carriers that the edge is in are
/// divided along the continuation of the path. Faces on the cut are divided at the edge, with the
/// same tolerance, and those behind the edge open. A carrier that the blade has cut by half or more
/// opens whole, since one that is cut in part moves as if it were whole (fragments::FragmentMesh).
/// So the cut ends up to half an element before or behind the edge, and on average at it. The front
/// is empty afterwards.
///
/// Parameters and cost are those of split(). Nothing happens if the front is empty. If the
/// continuation comes to an element that is no tetrahedron, no element is divided along it.
/// @param fragments  of the mesh
/// @pre  the tissue is at rest: before and after are the same
Split finish(topology::Mesh& mesh, const fragments::FragmentMesh& fragments,
             const TissueMotion& tissue, const BladeEnd& blade, CutFront& front,
             const SplitOptions& options, SnapHistory& snap_history,
             std::span<SuspendedCut> resting = {});

}  // namespace incise::cutting
