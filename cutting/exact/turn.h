// Which edge a cut divides next.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/cutting/exact/edge_list.h"

namespace incise::cutting {

/// An edge that a cut divides, in the order in which the blade comes to edges, so that the number
/// of steps does not matter. Of edges that it meets at once, the longest comes first, and of equal
/// ones the lowest. In a priority queue, the greatest is next.
struct Turn {
    double time;    ///< in the step: 0 before it, 1 after it
    double length;  ///< of the edge at rest, m
    Edge edge;
    bool operator<(const Turn& other) const {
        if (time != other.time) return time > other.time;
        return length != other.length ? length < other.length : other.edge < edge;
    }
};

}  // namespace incise::cutting
