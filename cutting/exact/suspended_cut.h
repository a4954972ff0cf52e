// A blade that is on its way through the body while another tool cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/surfaces/swept_edge.h"

namespace incise::cutting {

/// Where another cut divides elements that this blade has cut in part, its front has to keep count
/// of crossings, or the blade would find less than the whole of its cut when it goes on.
struct SuspendedCut {
    CutFront& front;
    SweptEdge edge;  ///< from where it is to there
    bool has_moved;  ///< in this step: tissue is where it is after the step, else before
    bool snaps;

    /// Whether its edge runs through the triangle.
    std::optional<bool> is_inside(std::array<MovingPoint, 3> triangle) const {
        for (MovingPoint& x : triangle) x[0] = x[1] = x[has_moved ? 1 : 0];
        return edge.ends_inside(triangle);
    }
};

}  // namespace incise::cutting
