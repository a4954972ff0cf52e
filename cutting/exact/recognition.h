// Recognizes nodes of earlier cuts where a cut passes through the same places.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// Puts nodes of earlier cuts on the front if the surface passes by them at the same place. It need
/// not cross an edge of theirs.
///
/// A node is frozen if an earlier cut had the same surface in space, and the node has not moved
/// across it by more than a tenth of an uncut element since. The cut then has nothing to add there.
/// Tissue under load moves after each cut, and its cut faces leave the surface. Nodes beside these
/// faces that the motion has carried through the surface are frozen, too. Such a surface is looked
/// for in all elements within this distance, and `edges` is not used.
/// @param tissue        the positions of the nodes
/// @param surface       what the cut follows
/// @param edges         of the elements near the surface, in any order
/// @param snap_history  of all earlier cuts
/// @param front         of this cut
void recognize(const TissueMotion& tissue, const CutSurface& surface,
               std::span<const EdgeList::Entry> edges, const SnapHistory& snap_history,
               CutFront& front);

}  // namespace incise::cutting
