// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/single_precision.h"

#include <algorithm>
#include <array>

#include "incise/base/number_format.h"
#include "incise/topology/mesh_metrics.h"

namespace incise::scenario {

namespace {

/// Returns the least altitude of a tetrahedron, or of its carrier, divided by the longest edge.
double thinness(const topology::Mesh& mesh, CellId e) {
    const topology::Carriers& carriers = mesh.source_carriers();
    std::array<Vec3, 4> x;
    if (carriers.is_empty() || carriers.of_cell[e.index()] == topology::Carriers::whole)
        for (std::size_t k = 0; k < 4; ++k) x[k] = mesh.rest_position(mesh.corners(e)[k]);
    else
        std::ranges::copy(carriers.corners[static_cast<std::size_t>(carriers.of_cell[e.index()])],
                          x.begin());
    double longest = 0.0;
    for (std::size_t k = 0; k < 4; ++k)
        for (std::size_t l = 0; l < k; ++l) longest = std::max(longest, (x[k] - x[l]).norm());
    return topology::min_altitude(topology::CellKind::tetrahedron, x) / longest;
}

}  // namespace

std::optional<std::string> warning_of_thin_elements(const topology::Mesh& mesh) {
    constexpr double least_thinness = 1e-2;  // below it, floats lose strains of a few per cent
    std::size_t num_thin = 0;
    double thinnest = 1.0;
    CellId thinnest_element;
    for (const CellId e : mesh.elements()) {
        if (mesh.kind(e) != topology::CellKind::tetrahedron) continue;
        const double ratio = thinness(mesh, e);
        if (ratio >= least_thinness) continue;
        ++num_thin;
        if (ratio < thinnest) {
            thinnest = ratio;
            thinnest_element = e;
        }
    }
    if (num_thin == 0) return std::nullopt;
    return "key 'dynamics.precision': \"single\" leaves no strain to speak of in " +
           std::to_string(num_thin) + (num_thin == 1 ? " tetrahedron" : " tetrahedra") +
           " with a least altitude below " + format_number(least_thinness) +
           " of the longest edge (the thinnest, element " +
           std::to_string(mesh.label(thinnest_element)) + ", has " + format_number(thinnest) +
           "); use \"double\", or a mesh without them";
}

}  // namespace incise::scenario
