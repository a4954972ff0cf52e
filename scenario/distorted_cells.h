// Cells of a mesh that the method heml cannot compute.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_data.h"

namespace incise::scenario {

/// Returns a message about each of the first few hexahedra, wedges and pyramids that cannot be
/// elements of the method heml, and one that counts the others: see
/// physics::VirtualCentreKernel::why_no_cell(). The other methods take no such cells either.
/// Cost: O(#cells).
/// @param checked  the result of topology::check(), without errors
std::vector<std::string> distorted_cells(const topology::MeshData& mesh,
                                         const topology::MeshCheck& checked);

}  // namespace incise::scenario
