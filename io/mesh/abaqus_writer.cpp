// Writer of Abaqus and CalculiX input (.inp). The files have no materials and no steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <map>
#include <utility>
#include <vector>

#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"

namespace incise::io {

namespace {

const char* abaqus_element_type(topology::CellKind kind) {
    using enum topology::CellKind;
    switch (kind) {
        case tetrahedron:
            return "C3D4";
        case hexahedron:
            return "C3D8";
        case wedge:
            return "C3D6";
        case pyramid:
            return "C3D5";
        case polyhedron:
            break;
    }
    return "";
}

}  // namespace

std::string abaqus_text(const topology::MeshData& mesh) {
    std::string text;
    if (mesh.points_may_coincide) text.append("** ").append(coincidence_mark).append("\n");
    text += "*NODE, NSET=ALL_NODES\n";
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        append_number(text, i + 1);
        text += ',';
        append_point(text, mesh.points[i], ',');
        text += '\n';
    }
    std::map<std::pair<int, topology::CellKind>, std::vector<std::size_t>> blocks;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c)
        blocks[{mesh.regions[c], mesh.kinds[c]}].push_back(c);
    for (const auto& [block, cells] : blocks) {
        const auto [region, kind] = block;
        text += std::string("*ELEMENT, TYPE=") + abaqus_element_type(kind) + ", ELSET=REGION_" +
                std::to_string(region) + "\n";
        for (const auto c : cells) {
            append_number(text, c + 1);  // numbers keep the order of the mesh
            for (const auto corner : with_wedges_facing_inwards(mesh, c)) {
                text += ',';
                append_number(text, corner + 1);
            }
            text += '\n';
        }
    }
    return text;
}

}  // namespace incise::io
