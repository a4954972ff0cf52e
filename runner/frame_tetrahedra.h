// Frames for programs that know no polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/vtk/frame.h"

namespace incise::runner {

/// Returns a frame in which tetrahedra stand for the polyhedra: about the mean of the corners of
/// each, to the triangles of its faces. Faces with more than three corners are divided about the
/// mean of their corners. So the tetrahedra of a polyhedron have its volume to rounding; some can
/// be turned inside out in one that is not convex. A whole cell beside a polyhedron keeps its
/// quadrilateral, on which the new point has no other cell.
///
/// Each new point has the mean of the values at the corners, but no mass and no force, so that sums
/// stay as they are, and the node_id -1. Tetrahedra have the values of their polyhedron, and its
/// faces on cuts. The frame has no carriers, unless it has no polyhedra: then it stays as it is.
/// Cost: some microseconds a polyhedron.
io::Frame with_tetrahedra(io::Frame frame);

}  // namespace incise::runner
