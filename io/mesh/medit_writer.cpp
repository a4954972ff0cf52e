// Writer of MEDIT files (.mesh) as text of version 2, which means coordinates in double precision.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"

namespace incise::io {

namespace {

struct Section {
    topology::CellKind kind;
    const char* keyword;
};

constexpr std::array<Section, topology::num_cell_kinds> sections = {{
    {topology::CellKind::tetrahedron, "Tetrahedra"},
    {topology::CellKind::hexahedron, "Hexahedra"},
    {topology::CellKind::wedge, "Prisms"},
    {topology::CellKind::pyramid, "Pyramids"},
}};

}  // namespace

std::string medit_text(const topology::MeshData& mesh) {
    std::string text = "MeshVersionFormatted 2\nDimension 3\n";
    if (mesh.points_may_coincide) text.append("# ").append(coincidence_mark).append("\n");
    text += "Vertices\n";
    append_number(text, mesh.points.size());
    text += '\n';
    for (const auto& point : mesh.points) {
        append_point(text, point);
        text += " 0\n";  // points have no reference
    }
    for (const auto& [kind, keyword] : sections) {
        const auto count = std::count(mesh.kinds.begin(), mesh.kinds.end(), kind);
        if (count == 0) continue;
        text += keyword;
        text += '\n';
        append_number(text, count);
        text += '\n';
        for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
            if (mesh.kinds[c] != kind) continue;
            for (const auto corner : with_wedges_facing_inwards(mesh, c)) {
                append_number(text, corner + 1);
                text += ' ';
            }
            append_number(text, mesh.regions[c]);
            text += '\n';
        }
    }
    return text + "End\n";
}

}  // namespace incise::io
