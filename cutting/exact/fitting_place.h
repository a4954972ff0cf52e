// Where to divide an edge so that no element becomes too small.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/step_length.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An edge to be divided, and the elements round it, all of which become two.
struct EdgeRing {
    NodeId a, b;
    std::span<const ElementId> elements;
};

struct FitLimits {
    const UncutBody& uncut;
    double least_step_share;  ///< of the uncut body's step length, to be left to every element
    double farthest;          ///< that nodes of the cut may be off the surface, m at rest
};

/// Where to divide the edge, 0 at a and 1 at b: on the surface; if a half would be too small, as
/// much nearer to the middle as nodes may be off the surface. If that does not do either, negative:
/// the nearer end is to count as on the surface; unless it is farther away than that, and half of
/// the share is enough.
double fitting_place(const topology::Mesh& mesh, const EdgeRing& ring,
                     const EdgeIntersection& intersection, const FitLimits& limits);

}  // namespace incise::cutting
