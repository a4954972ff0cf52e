// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/body_arrays.h"

#include "incise/physics/body/model.h"

namespace incise::physics {

BodyArrays body_arrays(const Model& model) {
    const fragments::FragmentMesh& fragments = model.fragments();
    BodyArrays arrays;
    std::vector<std::int64_t> row_of_node(fragments.node_capacity(), -1);
    for (const NodeId n : fragments.nodes()) {
        row_of_node[n.index()] = std::ssize(arrays.mesh.points);
        arrays.mesh.points.push_back(model.positions()[n.index()]);
        arrays.rest_positions.push_back(fragments.rest_position(n));
        arrays.velocities.push_back(model.velocities()[n.index()]);
        arrays.masses.push_back(model.masses()[n.index()]);
    }
    std::vector<std::int64_t> row_of_fragment(fragments.element_capacity(), -1);
    std::vector<std::int64_t> corners;
    for (const ElementId e : fragments.elements()) {
        row_of_fragment[e.index()] = static_cast<std::int64_t>(arrays.mesh.num_cells());
        corners.clear();
        for (const NodeId n : fragments.corners(e)) corners.push_back(row_of_node[n.index()]);
        arrays.mesh.add_cell(fragments.kind(e), corners, fragments.region(e));
        arrays.volume_shares.push_back(fragments.volume_share(e));
    }
    for (const CellId e : model.mesh().elements())
        arrays.cell_of_element.push_back(row_of_fragment[fragments.fragment_of_cell(e).index()]);
    return arrays;
}

}  // namespace incise::physics
