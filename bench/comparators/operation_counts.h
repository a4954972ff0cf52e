// Counts of the operations of one force evaluation. The papers count them in HEML 2006, Table 3,
// and HEML 2015, Table 5.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "bench/comparators/counted.h"
#include "bench/comparators/element_loop.h"
#include "incise/topology/mesh_data.h"

namespace incise::bench {

/// Returns the cube of the papers, of side 1. It has n x n x n bricks of five tetrahedra, one in
/// the middle and four at every other corner. Adjacent bricks are mirrored so that they fit. There
/// are 320 tetrahedra and 125 nodes with n = 4, 3645 and 1000 with n = 9.
topology::MeshData cube_of_five_tetrahedra(int n);

/// The operations of a method on a mesh, with the sums at the nodes.
struct MethodOperations {
    const char* name;
    Operations operations;
};
/// Counts the operations of every method of this folder that has a fixed number of them.
std::vector<MethodOperations> count_operations(std::span<const Nodes> tetrahedra,
                                               std::span<const Vec3> rest_positions);

/// Returns the operations of the mass-tensor model as the papers count them. The rule fits both of
/// their regular cubes. It has all pairs and triples of a node and its neighbours, also those that
/// share no element, whose tensors are zero. With n = 1 + number of neighbours, a node takes
/// 18 n + 41 n^2 + 12 n^3 operations, less 3, since the first term is not added to anything. The
/// 18 are the product of a matrix and a vector, and its addition.
std::int64_t printed_mass_tensor_operations(std::span<const Nodes> tetrahedra);

}  // namespace incise::bench
