// Which edges the cut passes through at a node that a division has made.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/exact/suspended_cut.h"

namespace incise::cutting {

/// Counts the crossings of the edges that the middle of the edge from a to b has come to. It counts
/// as on the side of the end b: where it is, if it was made off the surface. Round a triangle the
/// crossings are odd in number if the boundary of the sweep runs through it, and in no other case,
/// now and after each later step: rounding has moved the middle off the edge, so nothing of this
/// may be left to its place.
/// @param has_boundary  (p, q, r): whether the boundary runs through a triangle; nothing if the
/// surface
///                    has a boundary instead
/// @param is_passed_to_b  (i): whether a way from the middle's neighbour ring[i] to b by the middle
///                        crosses the surface; asked where the boundary is in their face
template <class HasBoundary, class IsPassed>
void place_on_side(CutFront& front, NodeId a, NodeId b, NodeId middle,
                   const std::vector<NodeId>& ring, HasBoundary has_boundary,
                   IsPassed is_passed_to_b) {
    const bool is_crossed = front.is_crossed(a, b);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const NodeId n = ring[i];
        const bool at_a = front.is_crossed(a, n), at_b = front.is_crossed(b, n);
        bool is_crossed_to_n = at_b;
        if (const std::optional<bool> boundary = has_boundary(middle, b, n))
            is_crossed_to_n = at_b != *boundary;
        else if (at_a != (at_b != is_crossed))  // the boundary is in the face: which half it is in
            is_crossed_to_n = is_passed_to_b(i);
        if (is_crossed_to_n) front.toggle(middle, n);
    }
    if (is_crossed) front.toggle(a, b);
    if (is_crossed != has_boundary(a, middle, b).value_or(false)) front.toggle(a, middle);
}

/// The same for a blade that this cut comes across. A middle between two nodes on its cut is on it,
/// too; any other keeps to an end that is off it, as edges without a node on it are not to stay
/// crossed.
/// @param local_edge_length  see CutFront::put_on
/// @param point  (node): where it is, a MovingPoint
template <class PointOf>
void position_of_suspended(const SuspendedCut& blade, Edge edge, NodeId middle,
                           const std::vector<NodeId>& ring, double local_edge_length,
                           SnapHistory& snap_history, PointOf point) {
    CutFront& front = blade.front;
    if (front.is_on(edge.a) && front.is_on(edge.b))
        front.put_on(middle, !front.is_near(edge.a) && !front.is_near(edge.b), local_edge_length,
                     snap_history.take_rank());
    else if (front.is_on(edge.b))
        std::swap(edge.a, edge.b);
    place_on_side(
        front, edge.a, edge.b, middle, ring,
        [&](NodeId p, NodeId q, NodeId r) {
            return blade.is_inside({point(p), point(q), point(r)});
        },
        [](std::size_t) { return false; });
    // Its cut ends beyond the middle, and goes through an edge that would have been divided.
    const bool is_passed = std::any_of(ring.begin(), ring.end(), [&](NodeId n) {
        return !front.is_on(n) && front.is_crossed(middle, n);
    });
    if (is_passed || (!front.is_on(edge.a) && front.is_crossed(middle, edge.a)))
        front.put_on(middle, false, local_edge_length, snap_history.take_rank());
}

}  // namespace incise::cutting
