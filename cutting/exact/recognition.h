// A cut finds what earlier ones have left where it passes through the same places.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// When a node came to count as on the cut.
struct Arrival {
    NodeId node;
    double time;  ///< see Crossing
};

/// Puts nodes on the front that counted as on an earlier cut, where the surface passes through the
/// same place, even if it crosses none of their edges. If it is the same surface, and neither the
/// node has moved nor do its neighbours, it has nothing to add: the node is settled.
/// @param edges  those of the elements near the surface, in any order
std::vector<Arrival> recognize(const TissueMotion& tissue, const CutSurface& surface,
                               std::span<const EdgeList::Entry> edges,
                               const SnapHistory& snap_history, CutFront& front);

}  // namespace incise::cutting
