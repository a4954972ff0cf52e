// What a report of cuts says about the body: its size, its quality and its pieces.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <vector>

#include "incise/base/types.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// A connected component of the body.
struct Piece {
    double volume = 0.0;  ///< m3
    std::size_t elements = 0;
};

/// Counts of the elements of the physics: fragments::FragmentMesh.
struct FragmentCounts {
    std::size_t fragments = 0;
    std::size_t ghost_nodes = 0;  ///< nodes of fragments without material at them
    double smallest_share = 1.0;  ///< of a fragment in the volume of its carrier
};

/// Size and quality of a body at rest.
struct BodyMeasures : FragmentCounts {
    std::size_t elements = 0, nodes = 0;
    double volume = 0.0;                                  ///< m3
    double min_dihedral_angle = 0.0;                      ///< radians
    double min_altitude = 0.0, mean_edge_length = 0.0;    ///< m
    Vec3 box_min = Vec3::Zero(), box_max = Vec3::Zero();  ///< bounding box, m
    /// The stable step of the fragments in a body of one material, times the speed of waves, m.
    double step_length = 0.0;
};

/// Returns the counts of the fragments of a mesh. Cost: O(n).
/// @param fragments  of the mesh, at its epoch
FragmentCounts counts_of(const topology::Mesh& mesh, const fragments::FragmentMesh& fragments);

/// Returns the measures of a body at rest.
/// Throws InputError for a body whose quality cannot be measured: see topology::measure().
/// @param fragments  of the mesh, at its epoch
/// Cost: O(n), some microseconds for each element.
BodyMeasures measures_of(const topology::Mesh& mesh, const fragments::FragmentMesh& fragments);

/// Returns the connected components of a body, the largest volume first. Cost: O(n).
std::vector<Piece> pieces_of(const topology::Mesh& mesh);

}  // namespace incise::cutting
