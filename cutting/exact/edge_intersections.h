// Where a surface passes through an edge of the mesh, and how far from its ends.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An edge of the mesh that may be crossed.
struct CrossableEdge {
    MovingPoint a, b;  ///< before and after the step, m
    Vec3 at_rest;      ///< from a to b, m
};

/// Where the surface passes through an edge, and how far away its ends are from it there, in units
/// of the edge's length at rest.
struct EdgeIntersection {
    double place, from_a, from_b;
    double time;          ///< 0 before the step, 1 after it
    Vec3 point, normal;   ///< after the step; the normal of unit length, or zero if not known
    Vec3 normal_at_rest;  ///< the same in the frame of rest
};
using EdgeIntersections = std::vector<EdgeIntersection>;  // in ascending order of places

/// In ascending order of places. Two at once that are nearer to each other than `apart`, a share of
/// the edge, are not told apart and cancel out.
std::vector<Crossing> crossings_of(const CutSurface& surface, const CrossableEdge& edge,
                                   double apart);

/// @param normal_at_rest  of the surface at the crossing, in the frame of rest and of any length;
///                        zero if not known: the surface then counts as perpendicular to the edge
EdgeIntersection intersection_at(const Crossing& crossing, const CutSurface& surface,
                                 const CrossableEdge& edge, const Vec3& normal_at_rest);

}  // namespace incise::cutting
