// Check of the invariants of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Returns a description of each violated invariant; empty if the mesh is valid.
///
/// The invariants are:
/// - the combinatorial map and the arrays agree, and CGAL finds the map valid
/// - neighbours name each other and share the nodes of their face
/// - the elements at each node are connected through faces at it
/// - incident_element() is the lowest element at each node
/// - corners are alive and distinct
/// - the counts of nodes and elements are right
/// - rest volumes are positive
///
/// Cost: some microseconds an element. Meant for tests and debug builds.
std::vector<std::string> validate(const Mesh& mesh);

/// Returns the same for the fragments of a mesh.
///
/// The invariants are:
/// - each living cell is in one fragment, of its region; the cells of a fragment name it
/// - a fragment has cells, and a positive share; shares add up to the volume of the mesh
/// - corners are alive, and copies of the corners of the carrier
/// - cells that share a face inside a carrier are in one fragment
/// - fragments of cells that share a face between carriers share the nodes of this face, if both
///   carry these cells at home
/// - fragments whose cells hang together are connected through common nodes
/// - the counts of nodes and elements are right, and each node has a fragment
std::vector<std::string> validate(const FragmentMesh& fragments, const Mesh& mesh);

}  // namespace incise::topology
