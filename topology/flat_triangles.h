// Triangles without area in a surface: caps, whose apex lies on the opposite edge.
// Source: Botsch, Kobbelt 2001, A robust procedure to eliminate degenerate faces from triangle
// meshes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/topology/surface_data.h"

namespace incise::topology {

/// Returns the surface without triangles that have repeated corners or no area. An apex that lies
/// on the opposite edge divides the triangle across that edge, so that a closed surface stays
/// closed. Points at the same position count as one. Triangles that remain keep their order. A
/// triangle without area that has no single triangle across its longest edge is left out. So are
/// flat triangles on both sides of one edge, if points of the two sides are at the same position:
/// the surface may be open there.
/// @param tolerance  a needle is also divided into its neighbour if its apex is not further than
///                   this from the opposite edge. The surface then moves by at most that distance.
/// Cost: O(n), and O(n log n) if there is such a triangle.
SurfaceData without_flat_triangles(SurfaceData surface, double tolerance = 0.0);

}  // namespace incise::topology
