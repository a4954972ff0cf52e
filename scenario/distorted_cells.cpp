// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/scenario/distorted_cells.h"

#include <cstddef>
#include <optional>

#include "incise/physics/elements/virtual_centre_kernel.h"
#include "incise/topology/joined_quads.h"

namespace incise::scenario {

using topology::CellKind;

namespace {

template <CellKind kind>
std::optional<std::string> why_no_cell_of(const topology::MeshData& mesh, std::size_t c,
                                          topology::Diagonals diagonals) {
    typename physics::VirtualCentreKernel<kind>::Corners corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
        corners[k] = mesh.points[static_cast<std::size_t>(mesh.cell(c)[k])];
    return physics::VirtualCentreKernel<kind>::why_no_cell(corners, diagonals);
}

std::optional<std::string> why_no_cell(const topology::MeshData& mesh, std::size_t c,
                                       topology::Diagonals diagonals) {
    switch (mesh.kinds[c]) {
        case CellKind::hexahedron:
            return why_no_cell_of<CellKind::hexahedron>(mesh, c, diagonals);
        case CellKind::wedge:
            return why_no_cell_of<CellKind::wedge>(mesh, c, diagonals);
        case CellKind::pyramid:
            return why_no_cell_of<CellKind::pyramid>(mesh, c, diagonals);
        case CellKind::tetrahedron:
        case CellKind::polyhedron:
            break;
    }
    return std::nullopt;
}

}  // namespace

std::vector<std::string> distorted_cells(const topology::MeshData& mesh,
                                         const topology::MeshCheck& checked) {
    const auto diagonals = topology::diagonals_of_cells(mesh, checked.joined_quads);
    constexpr std::size_t max_listed = 5;
    std::vector<std::string> found;
    std::size_t count = 0;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        if (const auto reason =
                why_no_cell(mesh, c, diagonals.empty() ? topology::Diagonals() : diagonals[c]);
            reason && ++count <= max_listed)
            found.push_back(mesh.cell_name(c) + " " + *reason);
    if (count > max_listed)
        found.push_back("and " + std::to_string(count - max_listed) + " more such cells");
    return found;
}

}  // namespace incise::scenario
