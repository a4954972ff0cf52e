// The edges of a new node that a cut passes through, found by counting intersections round
// triangles.
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

/// Counts the intersections of the new edges at `middle`, a node that divides the edge from a to b.
/// The middle counts as on the side of b.
///
/// The number of intersections round a triangle is odd if the boundary of the sweep passes through
/// the triangle, and in no other case. This must hold now and after each later step. As rounding
/// has moved the middle off the edge, no count may depend on its position.
/// @pre  if the middle was made off the surface, it is on the side of b
/// @param front           of the cut; takes the counts
/// @param a               the end of the edge that may be on the other side
/// @param b               the end on whose side the middle counts
/// @param middle          the new node
/// @param ring            the other nodes of the elements round the edge
/// @param has_boundary    (p, q, r): whether the boundary of the sweep passes through the triangle;
///                        nothing if the surface is not swept
/// @param is_passed_to_b  (i): whether the path from ring[i] by the middle to b crosses the
///                        surface; called only if the boundary of the surface is in the face of
///                        ring[i]
template <class HasBoundary, class IsPassed>
void place_on_side(CutFront& front, VertexId a, VertexId b, VertexId middle,
                   const std::vector<VertexId>& ring, HasBoundary has_boundary,
                   IsPassed is_passed_to_b) {
    const bool is_crossed = front.is_crossed(a, b);
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const VertexId n = ring[i];
        const bool at_a = front.is_crossed(a, n), at_b = front.is_crossed(b, n);
        bool is_crossed_to_n = at_b;
        if (const std::optional<bool> boundary = has_boundary(middle, b, n))
            is_crossed_to_n = at_b != *boundary;
        else if (at_a != (at_b != is_crossed))  // the boundary is in one half of the face
            is_crossed_to_n = is_passed_to_b(i);
        if (is_crossed_to_n) front.toggle(middle, n);
    }
    if (is_crossed) front.toggle(a, b);
    if (is_crossed != has_boundary(a, middle, b).value_or(false)) front.toggle(a, middle);
}

/// Counts the intersections at a new node for a suspended cut. A node between two nodes on the
/// suspended cut is on it, too. Any other keeps to the side of an end that is off the cut, since no
/// edge without a node on the cut may stay crossed.
/// @param blade              the suspended cut
/// @param edge               the edge that was divided
/// @param middle             the new node
/// @param ring               the other nodes of the elements round the edge
/// @param local_edge_length  see CutFront::put_on()
/// @param snap_history       gives the middle its rank
/// @param point              (node): its MovingPoint
template <class PointOf>
void position_of_suspended(const SuspendedCut& blade, Edge edge, VertexId middle,
                           const std::vector<VertexId>& ring, double local_edge_length,
                           SnapHistory& snap_history, PointOf point) {
    CutFront& front = blade.front;
    if (front.is_on(edge.a) && front.is_on(edge.b))
        front.put_on(middle, !front.is_near(edge.a) && !front.is_near(edge.b), local_edge_length,
                     snap_history.take_rank());
    else if (front.is_on(edge.b))
        std::swap(edge.a, edge.b);
    place_on_side(
        front, edge.a, edge.b, middle, ring,
        [&](VertexId p, VertexId q, VertexId r) {
            return blade.is_inside({point(p), point(q), point(r)});
        },
        [](std::size_t) { return false; });
    // The suspended cut ends beyond the middle, and passes through an edge that it would have
    // divided.
    const bool is_passed = std::any_of(ring.begin(), ring.end(), [&](VertexId n) {
        return !front.is_on(n) && front.is_crossed(middle, n);
    });
    if (is_passed || (!front.is_on(edge.a) && front.is_crossed(middle, edge.a)))
        front.put_on(middle, false, local_edge_length, snap_history.take_rank());
}

}  // namespace incise::cutting
