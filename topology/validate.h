// Whole-mesh invariants.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/mesh.h"

namespace incise::topology {

/// Says everything that is wrong with the mesh; empty if all is well. Checks that map and flat
/// arrays agree and CGAL calls the map valid; that neighbours know each other and share their
/// nodes; that each node is one face-connected star with the right incident_element; that corners
/// are alive and distinct, counts right and rest volumes positive. Cost: some microseconds an
/// element; for tests and debug builds.
std::vector<std::string> validate(const Mesh& mesh);

}  // namespace incise::topology
