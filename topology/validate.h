// Check of the invariants of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/mesh.h"

namespace incise::topology {

/// Returns a description of each violated invariant; empty if the mesh is valid.
///
/// The invariants are:
/// - neighbours name each other and share the nodes of their face
/// - the elements at each node are connected through faces at it
/// - incident_element() is the lowest element at each node
/// - corners are alive and distinct
/// - the counts of nodes and elements are right
/// - rest volumes are positive
///
/// Cost: some microseconds an element. Meant for tests and debug builds.
std::vector<std::string> validate(const Mesh& mesh);

}  // namespace incise::topology
