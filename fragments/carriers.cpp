// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/carriers.h"

#include <algorithm>
#include <vector>

namespace incise::fragments {

using topology::Carriers;
using topology::Mesh;

namespace {

bool is_whole(const Mesh& mesh, const FragmentMesh& fragments, CellId e) {
    const auto cell = topology::cell_of_source(mesh, e);
    return cell && std::ranges::equal(
                       cell->corners(), fragments.origins_of(fragments.carrier_of_cell(e)), {},
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
        std::int64_t& row = row_of[carrier.index()];
        if (row == Carriers::whole) {
            row = std::ssize(carriers.corners);
            std::vector<Vec3> corners;
            for (const NodeId n : fragments.origins_of(carrier))
                corners.push_back(fragments.rest_position(n));
            carriers.corners.emplace_back(fragments.kind_of(carrier), corners).diagonals =
                fragments.diagonals_of(carrier);
        }
        carriers.of_cell.back() = row;
    }
    if (carriers.corners.empty()) carriers.of_cell.clear();
    return carriers;
}

}  // namespace incise::fragments
