// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/carriers.h"

#include <algorithm>
#include <vector>

namespace incise::fragments {

using topology::Carriers;
using topology::Mesh;

namespace {

bool is_whole(const Mesh& mesh, const FragmentMesh& fragments, CellId e) {
    return std::ranges::equal(
        mesh.corners(e), fragments.origins_of(fragments.carrier_of_cell(e)), {},
        [&](VertexId n) { return mesh.rest_position(n); },
        [&](NodeId n) { return fragments.rest_position(n); });
}

}  // namespace

Carriers carriers_of(const Mesh& mesh, const FragmentMesh& fragments) {
    Carriers carriers;
    std::vector<std::int64_t> row_of(mesh.element_capacity(), Carriers::whole);
    for (const CellId e : mesh.elements()) {
        carriers.of_cell.push_back(Carriers::whole);
        if (is_whole(mesh, fragments, e)) continue;
        const CarrierId carrier = fragments.carrier_of_cell(e);
        if (fragments.origins_of(carrier).size() != 4) continue;
        std::int64_t& row = row_of[carrier.index()];
        if (row == Carriers::whole) {
            row = std::ssize(carriers.corners);
            std::array<Vec3, 4>& corners = carriers.corners.emplace_back();
            for (std::size_t k = 0; k < 4; ++k)
                corners[k] = fragments.rest_position(fragments.origins_of(carrier)[k]);
        }
        carriers.of_cell.back() = row;
    }
    if (carriers.corners.empty()) carriers.of_cell.clear();
    return carriers;
}

}  // namespace incise::fragments
