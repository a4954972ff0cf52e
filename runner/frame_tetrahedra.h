// Frames for programs that know no polyhedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/vtk/frame.h"

namespace incise::runner {

/// Returns a frame in which all cells are tetrahedra: see topology::divide_into_tetrahedra(). So
/// they hang together as the cells do. The division is that of the body at rest, so that it does
/// not change as the body moves, and a reader gets the body at rest.
///
/// Each new point has the mean of the values at the corners, but no mass and no force, so that sums
/// stay as they are, and the node_id -1. Tetrahedra have the values of their cell. The frame has no
/// carriers, unless all cells were tetrahedra: then it stays as it is.
/// Cost: some microseconds a cell.
io::Frame with_tetrahedra(io::Frame frame);

}  // namespace incise::runner
