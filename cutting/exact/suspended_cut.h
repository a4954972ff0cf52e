// A cut in progress that does not act while another tool cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <optional>

#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/surfaces/swept_edge.h"

namespace incise::cutting {

/// A suspended cut of a blade. Where another cut divides elements that this one has cut in part,
/// its front must keep count of the intersections. Otherwise the blade would not find all of its
/// cut when it goes on.
template <class Front>
struct SuspendedCutOf {
    Front& front;
    SweptEdge edge;  ///< of the blade, at rest where it is
    /// True if the blade has moved in this step. Tissue is then where it is after the step, else
    /// before.
    bool has_moved;

    /// True if the blade's edge passes through the triangle an odd number of times.
    std::optional<bool> is_inside(std::array<MovingPoint, 3> triangle) const {
        for (MovingPoint& x : triangle) x[0] = x[1] = x[has_moved ? 1 : 0];
        return edge.ends_inside(triangle);
    }
};

using SuspendedCut = SuspendedCutOf<CutFront>;

}  // namespace incise::cutting
