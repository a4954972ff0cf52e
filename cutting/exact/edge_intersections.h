// Intersections of a cut surface with an edge of the mesh: docs/theory.md, Crossings in space and
// time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An edge of the mesh that a surface may cross.
struct CrossableEdge {
    MovingPoint a, b;  ///< before and after the step, m
    Vec3 at_rest;      ///< from a to b in the rest frame, m
};

/// An intersection of a surface with an edge: the edge parameter, and the distances of both ends
/// from the surface there, in lengths of the edge.
struct EdgeIntersection {
    double place, from_a, from_b;
    double time;          ///< 0 before the step, 1 after it
    Vec3 point, normal;   ///< after the step, m; the normal of unit length, or zero if not known
    Vec3 normal_at_rest;  ///< the same normal in the rest frame
};
using EdgeIntersections = std::vector<EdgeIntersection>;  // in ascending order of edge parameters

/// Returns the intersections in ascending order of edge parameters. Two at once that are nearer to
/// each other than `apart`, a share of the edge, cancel out.
std::vector<Crossing> crossings_of(const CutSurface& surface, const CrossableEdge& edge,
                                   double apart);

/// Returns an intersection with the distances of both ends from the surface.
/// @param crossing        of the surface and the edge
/// @param surface         gives the distances if it is not flat
/// @param edge            the edge
/// @param normal_at_rest  of the surface at the crossing, in the rest frame and of any length; if
///                        zero, it is not known, and the surface counts as perpendicular to the
///                        edge
EdgeIntersection intersection_at(const Crossing& crossing, const CutSurface& surface,
                                 const CrossableEdge& edge, const Vec3& normal_at_rest);

}  // namespace incise::cutting
