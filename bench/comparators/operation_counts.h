// Operations of one force evaluation, recounted: HEML 2006, Table 3; HEML 2015, Table 5.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "bench/comparators/counted.h"
#include "bench/comparators/element_loop.h"
#include "incise/topology/mesh_data.h"

namespace incise::bench {

/// The papers' cubes: n x n x n bricks of five tetrahedra, one in the middle and four at every
/// other corner, neighbours mirrored so that they fit. 320 tetrahedra and 125 nodes with n = 4,
/// 3645 and 1000 with n = 9. Side 1.
topology::MeshData cube_of_five_tetrahedra(int n);

/// A method's operations on a mesh, with summing up at the nodes.
struct MethodOperations {
    const char* name;
    Operations operations;
};
/// Every method of this folder that has a fixed number of operations, on tetrahedra.
std::vector<MethodOperations> count_operations(std::span<const Nodes> tetrahedra,
                                               std::span<const Vec3> rest_positions);

/// How the papers counted the mass-tensor model, found from both of their regular cubes: all pairs
/// and triples of a node and its neighbours, also those that no element joins, whose tensors are
/// zero. With n = 1 + number of neighbours, a node takes 18 n (a matrix times a vector, added) + 41
/// n^2 + 12 n^3 operations, less 3 for the first term, to which nothing is added.
std::int64_t printed_mass_tensor_operations(std::span<const Nodes> tetrahedra);

}  // namespace incise::bench
