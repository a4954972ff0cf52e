// Finds where to divide an edge so that no element becomes too small.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>

#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/step_length.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An edge to be divided, and the elements round it. Each of these becomes two.
struct EdgeRing {
    NodeId a, b;
    std::span<const ElementId> elements;
};

/// The limits within which an edge may be divided.
struct FitLimits {
    const UncutBody& uncut;
    double least_step_share;  ///< of the uncut body's step length, for every element
    double farthest;          ///< largest distance of nodes of the cut from the surface, m at rest
};

/// Returns the edge parameter at which to divide an edge, or a negative number if its nearer end is
/// to count as on the surface. These remedies are tried in turn, until no half is too small:
/// - the edge parameter of the intersection
/// - one nearer to the middle of the edge, by as much as nodes may be off the surface
/// - the nearer end, if it is no farther from the surface than that
/// - the second one again, if half of the share is enough
///
/// If none of them does, the nearer end counts as on the surface, however far it is.
double fitting_place(const topology::Mesh& mesh, const EdgeRing& ring,
                     const EdgeIntersection& intersection, const FitLimits& limits);

}  // namespace incise::cutting
