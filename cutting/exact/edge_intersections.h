// Intersections of a cut surface with an edge of the mesh: docs/theory.md, Crossings in space and
// time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/surfaces/cut_surface.h"

namespace incise::cutting {

/// An intersection of a surface with an edge.
struct EdgeIntersection {
    double place;        ///< edge parameter: 0 at the first end, 1 at the second one
    double time;         ///< 0 before the step, 1 after it
    Vec3 point, normal;  ///< after the step, m; the normal of unit length, or zero if not known
};
using EdgeIntersections = std::vector<EdgeIntersection>;  // in ascending order of edge parameters

/// Returns the end of an edge that is nearer to an intersection with it, or the first if both are
/// equally near.
inline VertexId nearer_end(const Edge& edge, const EdgeIntersection& intersection) {
    return intersection.place <= 0.5 ? edge.a : edge.b;
}

/// Returns the intersections of a surface with the edge from `a` to `b`, in ascending order of edge
/// parameters. Two at once that are nearer to each other than `apart`, a share of the edge, cancel
/// out.
EdgeIntersections intersections_of(const CutSurface& surface, const MovingPoint& a,
                                   const MovingPoint& b, double apart);

}  // namespace incise::cutting
