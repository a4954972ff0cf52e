// The nodes and elements that move a body, as arrays without gaps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/mesh_data.h"

namespace incise::physics {

class Model;

/// The nodes and elements of the physics: fragments::FragmentMesh. The sums of m v and m v^2 / 2
/// over these nodes are the momentum and the kinetic energy of the body. The nodes of the mesh that
/// is cut do not give them: they follow these nodes, and their masses say where material is.
struct BodyArrays {
    /// The fragments as cells, at the present positions of their nodes, m. A fragment has the
    /// corners of its whole carrier, so that cells of a cut body overlap. Rows of points and cells
    /// are in ascending order of the ids in Model::fragments().
    topology::MeshData mesh;
    // By point.
    std::vector<Vec3> rest_positions;  ///< m
    std::vector<Vec3> velocities;      ///< m/s
    std::vector<double> masses;        ///< kg
    /// By cell of `mesh`: the volume of the material that the fragment carries over that of its
    /// carrier, see FragmentMesh::share().
    std::vector<double> volume_shares;
    /// By living element of Model::mesh(), in ascending order: the cell of `mesh` that carries it.
    std::vector<std::int64_t> cell_of_element;
};

/// Returns the arrays of a body. Cost: O(n).
BodyArrays body_arrays(const Model& model);

}  // namespace incise::physics
