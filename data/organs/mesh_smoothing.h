// Smoothing of tetrahedra for the sake of the time step: nodes move so that the flattest elements
// get higher (optimisation-based smoothing: Freitag and Ollivier-Gooch 1997).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "data/organs/organ_shapes.h"
#include "incise/topology/mesh_data.h"

namespace incise::organs {

/// Moves nodes of elements that have an altitude below `target` (metres), each so that the smallest
/// altitude round it grows. Those on the surface and between the regions stay there.
/// @pre all cells are tetrahedra of positive volume that fill the organ
/// Cost: some microseconds a node and trial, a second for 20 000 tetrahedra.
void raise_altitudes(topology::MeshData& mesh, const Organ& organ, double target);

}  // namespace incise::organs
