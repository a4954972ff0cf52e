// Writer of legacy VTK files (.vtk) as text of version 3.0, which all readers of the format know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"

namespace incise::io {

namespace {

const char* legacy_cell_type(topology::CellKind kind) {
    using enum topology::CellKind;
    switch (kind) {
        case tetrahedron:
            return "10\n";
        case hexahedron:
            return "12\n";
        case wedge:
            return "13\n";
        case pyramid:
            return "14\n";
        case polyhedron:
            break;
    }
    return "";
}

}  // namespace

std::string legacy_vtk_text(const topology::MeshData& mesh) {
    const auto num_cells = std::to_string(mesh.num_cells());
    std::string text = "# vtk DataFile Version 3.0\n";
    text.append(mesh.points_may_coincide ? coincidence_mark : "mesh");
    text += "\nASCII\nDATASET UNSTRUCTURED_GRID\n";
    text += "POINTS " + std::to_string(mesh.points.size()) + " double\n";
    for (const auto& point : mesh.points) {
        append_point(text, point);
        text += '\n';
    }
    text += "CELLS " + num_cells + " " + std::to_string(mesh.num_cells() + mesh.corners.size());
    text += '\n';
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        append_number(text, mesh.cell(c).size());
        for (const auto corner : mesh.cell(c)) {
            text += ' ';
            append_number(text, corner);
        }
        text += '\n';
    }
    text += "CELL_TYPES " + num_cells + "\n";
    for (const auto kind : mesh.kinds) text += legacy_cell_type(kind);
    text += "CELL_DATA " + num_cells + "\nSCALARS region int 1\nLOOKUP_TABLE default\n";
    for (const auto region : mesh.regions) {
        append_number(text, region);
        text += '\n';
    }
    return text;
}

}  // namespace incise::io
