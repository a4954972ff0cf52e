// Writer of legacy VTK files (.vtk) as text of version 3.0, which all readers of the format know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/number_format.h"
#include "incise/io/mesh/mesh_text.h"
#include "incise/io/vtk/vtk_cells.h"
#include "incise/topology/source_faces.h"

namespace incise::io {

namespace {

/// Returns the entries of a cell in CELLS: its corners, or the faces of a polyhedron, each behind
/// the number of its corners, behind their number.
std::vector<std::int64_t> entries_of(const topology::MeshData& mesh,
                                     const topology::SourceFaces& faces, std::size_t c) {
    if (mesh.kinds[c] != topology::CellKind::polyhedron)
        return {mesh.cell(c).begin(), mesh.cell(c).end()};
    std::vector<std::int64_t> entries{faces.num_faces(c)};
    for (int f = 0; f < faces.num_faces(c); ++f) {
        const auto points = faces.points({c, f});
        entries.push_back(std::ssize(points));
        entries.insert(entries.end(), points.begin(), points.end());
    }
    return entries;
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
    const topology::SourceFaces faces(mesh);
    std::size_t num_entries = mesh.num_cells();
    std::string cells;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        const auto entries = entries_of(mesh, faces, c);
        num_entries += entries.size();
        append_number(cells, entries.size());
        for (const auto entry : entries) {
            cells += ' ';
            append_number(cells, entry);
        }
        cells += '\n';
    }
    text += "CELLS " + num_cells + " " + std::to_string(num_entries) + "\n" + cells;
    text += "CELL_TYPES " + num_cells + "\n";
    for (const auto kind : mesh.kinds) text += std::to_string(vtk_cell_type(kind)) + "\n";
    text += "CELL_DATA " + num_cells + "\nSCALARS region int 1\nLOOKUP_TABLE default\n";
    for (const auto region : mesh.regions) {
        append_number(text, region);
        text += '\n';
    }
    return text;
}

}  // namespace incise::io
