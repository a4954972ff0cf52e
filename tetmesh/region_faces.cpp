// SPDX-License-Identifier: GPL-3.0-or-later
#include "tetmesh/region_faces.h"

#include <algorithm>
#include <utility>

#include "incise/topology/cell_kind.h"

namespace incise::tetmesh {

std::vector<RegionFace> region_faces(const topology::MeshData& mesh) {
    struct Side {
        std::array<std::int64_t, 3> sorted, nodes;
        int region;
    };
    const auto& tetrahedron = topology::traits(topology::CellKind::tetrahedron);
    std::vector<Side> sides;
    sides.reserve(4 * mesh.num_cells());
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        for (int f = 0; f < tetrahedron.num_faces; ++f) {
            Side side{{}, {}, mesh.regions[c]};
            const auto local = tetrahedron.face(f);
            for (std::size_t k = 0; k < 3; ++k)
                side.nodes[k] = mesh.cell(c)[static_cast<std::size_t>(local[k])];
            side.sorted = side.nodes;
            std::ranges::sort(side.sorted);
            sides.push_back(side);
        }
    std::ranges::sort(sides, {}, [](const Side& s) { return std::pair(s.sorted, s.region); });
    std::vector<RegionFace> faces;
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const bool has_two = i + 1 < sides.size() && sides[i].sorted == sides[i + 1].sorted;
        if (!has_two)
            faces.push_back({sides[i].nodes, sides[i].region, 0});
        else if (sides[i].region != sides[i + 1].region)
            faces.push_back({sides[i].nodes, sides[i].region, sides[i + 1].region});
        if (has_two) ++i;
    }
    return faces;
}

}  // namespace incise::tetmesh
