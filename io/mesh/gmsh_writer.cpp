// Writer of Gmsh files (.msh) as text of version 2.2, which all readers of the format know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"

namespace incise::io {

namespace {

int gmsh_element_type(topology::CellKind kind) {
    using enum topology::CellKind;
    switch (kind) {
        case tetrahedron:
            return 4;
        case hexahedron:
            return 5;
        case wedge:
            return 6;
        case pyramid:
            return 7;
        case polyhedron:
            break;
    }
    return 0;
}

}  // namespace

std::string gmsh_text(const topology::MeshData& mesh) {
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n";
    if (mesh.points_may_coincide)
        text.append("$Comments\n").append(coincidence_mark).append("\n$EndComments\n");
    text += "$Nodes\n";
    append_number(text, mesh.points.size());
    text += '\n';
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        append_number(text, i + 1);
        text += ' ';
        append_point(text, mesh.points[i]);
        text += '\n';
    }
    text += "$EndNodes\n$Elements\n";
    append_number(text, mesh.num_cells());
    text += '\n';
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        // Number, type, and two tags: the physical group and the geometric entity.
        append_number(text, c + 1);
        text += ' ';
        append_number(text, gmsh_element_type(mesh.kinds[c]));
        text += " 2 ";
        append_number(text, mesh.regions[c]);
        text += ' ';
        append_number(text, mesh.regions[c]);
        for (const auto corner : with_wedges_facing_inwards(mesh, c)) {
            text += ' ';
            append_number(text, corner + 1);
        }
        text += '\n';
    }
    return text + "$EndElements\n";
}

}  // namespace incise::io
