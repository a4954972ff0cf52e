// Writer of USD as text (.usda): one prim of the type TetMesh, in metres, with a subset a region.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <map>
#include <vector>

#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"

namespace incise::io {

namespace {

/// A name in USD cannot have the sign of a negative number.
std::string name_of_region(int region) {
    const auto number = std::to_string(region);
    return "REGION_" + (region < 0 ? "m" + number.substr(1) : number);
}

void append_tuple(std::string& text, const Vec3& point) {
    text += '(';
    append_point(text, point, ',');
    text += ')';
}

}  // namespace

std::string usda_text(const topology::MeshData& mesh) {
    std::string text = "#usda 1.0\n";
    if (mesh.points_may_coincide) text.append("# ").append(coincidence_mark).append("\n");
    text += "(\n    defaultPrim = \"Body\"\n    metersPerUnit = 1\n)\n\ndef TetMesh \"Body\"\n{\n";
    if (!mesh.points.empty()) {
        Vec3 low = mesh.points.front(), high = low;
        for (const auto& point : mesh.points) {
            low = low.cwiseMin(point);
            high = high.cwiseMax(point);
        }
        text += "    float3[] extent = [";
        append_tuple(text, low);
        text += ", ";
        append_tuple(text, high);
        text += "]\n";
    }
    text += "    uniform token orientation = \"rightHanded\"\n    point3f[] points = [";
    // Programs of USD read the points in single precision. The digits read back to the same bits.
    for (std::size_t p = 0; p < mesh.points.size(); ++p) {
        text += p > 0 ? ",\n        " : "\n        ";
        append_tuple(text, mesh.points[p]);
    }
    text += "\n    ]\n    int4[] tetVertexIndices = [";
    std::map<int, std::vector<std::size_t>> cells_of_region;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        text += c > 0 ? ",\n        (" : "\n        (";
        for (std::size_t k = 0; k < mesh.cell(c).size(); ++k) {
            if (k > 0) text += ',';
            append_number(text, mesh.cell(c)[k]);
        }
        text += ')';
        if (mesh.regions[c] != 0) cells_of_region[mesh.regions[c]].push_back(c);
    }
    text += "\n    ]\n";
    for (const auto& [region, cells] : cells_of_region) {
        text += "\n    def GeomSubset \"" + name_of_region(region) +
                "\"\n    {\n        uniform token elementType = \"tetrahedron\"\n"
                "        uniform token familyName = \"region\"\n        int[] indices = [";
        for (std::size_t i = 0; i < cells.size(); ++i) {
            if (i > 0) text += ',';
            append_number(text, cells[i]);
        }
        text += "]\n    }\n";
    }
    return text + "}\n";
}

}  // namespace incise::io
