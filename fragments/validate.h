// Check of the invariants of fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// Returns a description of each violated invariant of the fragments of a mesh; empty if they are
/// valid.
///
/// The invariants are:
/// - each living cell is in one fragment, of its region; the cells of a fragment name it
/// - a fragment has cells, and a positive share; shares add up to the volume of the mesh, and those
///   of the tetrahedra of a fragment to its volume
/// - corners are alive, and copies of the corners of the carrier
/// - cells that share a face inside a carrier are in one fragment
/// - fragments of cells that share a face between carriers share the nodes of this face, if both
///   carry these cells at home
/// - fragments whose cells hang together are connected through common nodes
/// - the counts of nodes and elements are right, and each node has a fragment
std::vector<std::string> validate(const FragmentMesh& fragments, const topology::Mesh& mesh);

}  // namespace incise::fragments
