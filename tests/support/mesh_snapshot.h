// All that a mesh's readers can see, as one comparable value.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/topology/mesh.h"

namespace incise::test {

struct MeshSnapshot {
    std::uint64_t epoch;
    std::size_t num_nodes, num_elements, element_capacity;
    std::vector<Vec3> rest_positions;
    std::vector<CellId> anchors;
    std::vector<std::vector<VertexId>> corners;  // of living elements
    std::vector<std::vector<FaceId>> neighbors;  // of living elements
    std::vector<topology::CellShape> shapes;     // of living elements
    bool operator==(const MeshSnapshot&) const = default;

    explicit MeshSnapshot(const topology::Mesh& mesh)
        : epoch(mesh.epoch()),
          num_nodes(mesh.num_nodes()),
          num_elements(mesh.num_elements()),
          element_capacity(mesh.element_capacity()),
          rest_positions(mesh.rest_positions().begin(), mesh.rest_positions().end()) {
        for (std::size_t n = 0; n < mesh.node_capacity(); ++n)
            anchors.push_back(mesh.incident_element(VertexId(n)));
        for (std::size_t i = 0; i < element_capacity; ++i) {
            const CellId e(i);
            corners.emplace_back();
            neighbors.emplace_back();
            shapes.emplace_back();
            if (!mesh.is_alive(e)) continue;
            corners.back().assign(mesh.corners(e).begin(), mesh.corners(e).end());
            shapes.back() = mesh.shape(e);
            for (int f = 0; f < mesh.num_faces(e); ++f)
                neighbors.back().push_back(mesh.neighbor({e, f}));
        }
    }
};

}  // namespace incise::test
