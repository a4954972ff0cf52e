// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/io/vtk/vtk_cells.h"

#include "incise/base/error.h"
#include "incise/io/files/input_file.h"
#include "incise/io/files/number_text.h"

namespace incise::io {

namespace {

using topology::CellKind;
using enum CellForm::Use;

// In cells of higher order, the corners come first, in the order of the linear cell.
constexpr CellForm forms[] = {
    {0, "empty cell", 0, ignore},
    {1, "vertex cell", 1, ignore},
    {2, "vertex set", 0, ignore},
    {3, "line", 2, ignore},
    {4, "polyline", 0, ignore},
    {5, "triangle", 3, ignore},
    {6, "triangle strip", 0, ignore},
    {7, "polygon", 0, ignore},
    {8, "pixel", 4, ignore},
    {9, "quadrilateral", 4, ignore},
    {10, "tetrahedron", 4, keep, CellKind::tetrahedron},
    {11, "voxel", 8, keep, CellKind::hexahedron, {0, 1, 3, 2, 4, 5, 7, 6}},
    {12, "hexahedron", 8, keep, CellKind::hexahedron},
    {13, "wedge", 6, keep, CellKind::wedge},
    {14, "pyramid", 5, keep, CellKind::pyramid},
    {15, "pentagonal prism", 10},
    {16, "hexagonal prism", 12},
    {21, "quadratic line", 3, ignore},
    {22, "quadratic triangle", 6, ignore},
    {23, "quadratic quadrilateral", 8, ignore},
    {24, "quadratic tetrahedron", 10, by_corners, CellKind::tetrahedron},
    {25, "quadratic hexahedron", 20, by_corners, CellKind::hexahedron},
    {26, "quadratic wedge", 15, by_corners, CellKind::wedge},
    {27, "quadratic pyramid", 13, by_corners, CellKind::pyramid},
    {28, "biquadratic quadrilateral", 9, ignore},
    {29, "triquadratic hexahedron", 27, by_corners, CellKind::hexahedron},
    {30, "quadratic linear quadrilateral", 6, ignore},
    {31, "quadratic linear wedge", 12, by_corners, CellKind::wedge},
    {32, "biquadratic wedge", 18, by_corners, CellKind::wedge},
    {33, "biquadratic hexahedron", 24, by_corners, CellKind::hexahedron},
    {34, "biquadratic triangle", 7, ignore},
    {35, "cubic line", 4, ignore},
    {36, "quadratic polygon", 0, ignore},
    {37, "triquadratic pyramid", 19, by_corners, CellKind::pyramid},
    {41, "convex point set", 0},
    {42, "polyhedron", 0, keep, CellKind::polyhedron},
    {51, "parametric curve", 0, ignore},
    {52, "parametric surface", 0, ignore},
    {53, "parametric triangular surface", 0, ignore},
    {54, "parametric quadrilateral surface", 0, ignore},
    {55, "parametric tetrahedral region", 0},
    {56, "parametric hexahedral region", 0},
    {60, "higher-order line", 0, ignore},
    {61, "higher-order triangle", 0, ignore},
    {62, "higher-order quadrilateral", 0, ignore},
    {63, "higher-order polygon", 0, ignore},
    {64, "higher-order tetrahedron", 0, by_corners, CellKind::tetrahedron},
    {65, "higher-order wedge", 0, by_corners, CellKind::wedge},
    {66, "higher-order pyramid", 0, by_corners, CellKind::pyramid},
    {67, "higher-order hexahedron", 0, by_corners, CellKind::hexahedron},
    {68, "Lagrange line", 0, ignore},
    {69, "Lagrange triangle", 0, ignore},
    {70, "Lagrange quadrilateral", 0, ignore},
    {71, "Lagrange tetrahedron", 0, by_corners, CellKind::tetrahedron},
    {72, "Lagrange hexahedron", 0, by_corners, CellKind::hexahedron},
    {73, "Lagrange wedge", 0, by_corners, CellKind::wedge},
    {74, "Lagrange pyramid", 0, by_corners, CellKind::pyramid},
    {75, "Bezier line", 0, ignore},
    {76, "Bezier triangle", 0, ignore},
    {77, "Bezier quadrilateral", 0, ignore},
    {78, "Bezier tetrahedron", 0, by_corners, CellKind::tetrahedron},
    {79, "Bezier hexahedron", 0, by_corners, CellKind::hexahedron},
    {80, "Bezier wedge", 0, by_corners, CellKind::wedge},
    {81, "Bezier pyramid", 0, by_corners, CellKind::pyramid},
};
static_assert(std::is_sorted(std::begin(forms), std::end(forms),
                             [](const auto& a, const auto& b) { return a.code < b.code; }));

std::string quoted_list(const std::vector<std::string>& names) {
    std::string list;
    for (const auto& name : names) list += (list.empty() ? "" : ", ") + in_quotes(name);
    return list;
}

/// Appends a polyhedron. Its faces must fill their range and name the points of the cell.
/// @param first_point  number in the mesh of the first point of the piece
void keep_polyhedron(const VtkPiece& piece, std::size_t c, std::int64_t first_point,
                     std::span<const std::int64_t> nodes, int region, const std::string& here,
                     topology::MeshData& mesh) {
    const auto refuse = [&](const std::string& what) {
        throw InputError(here + ": " + what + "; the file is damaged");
    };
    const auto begin = static_cast<std::size_t>(piece.face_begins[c]),
               end = static_cast<std::size_t>(piece.face_ends[c]);
    std::vector<std::int64_t> list(piece.faces.begin() + piece.face_begins[c],
                                   piece.faces.begin() + piece.face_ends[c]);
    const std::int64_t num_faces = begin < end ? list.front() : 0;
    if (num_faces < 1) refuse("a polyhedron has " + std::to_string(num_faces) + " faces");
    std::size_t at = 1;
    std::vector<std::int64_t> named;
    for (std::int64_t f = 0; f < num_faces; ++f) {
        const std::int64_t size = at < list.size() ? list[at++] : -1;
        if (size < 0 || size > std::ssize(list) - static_cast<std::int64_t>(at))
            refuse("face " + std::to_string(f) + " of " + std::to_string(num_faces) +
                   " ends behind the faces of the polyhedron");
        if (size < 3)
            refuse("face " + std::to_string(f) + " of " + std::to_string(num_faces) + " has " +
                   std::to_string(size) + " points");
        for (std::int64_t left = size; left > 0; --left, ++at) {
            const std::int64_t most = std::ssize(mesh.points) - 1 - first_point;
            if (list[at] < 0 || list[at] > most)
                refuse("face " + std::to_string(f) + " names point " + std::to_string(list[at]) +
                       " of " + std::to_string(most + 1));
            named.push_back(list[at]);
            list[at] += first_point;
        }
    }
    if (at != list.size())
        refuse("a polyhedron has " + std::to_string(list.size()) +
               " numbers for its faces, which fill " + std::to_string(at));
    std::vector<std::int64_t> corners(nodes.begin(), nodes.end());
    for (std::int64_t& n : named) n += first_point;
    for (auto* points : {&named, &corners}) {
        std::ranges::sort(*points);
        points->erase(std::unique(points->begin(), points->end()), points->end());
    }
    if (named != corners) refuse("a polyhedron has other points than its faces");
    mesh.add_polyhedron(list, region);
}

/// Sets which faces of the last cell are on a cut, in one of the lists.
void keep_cut_faces(std::size_t list, std::int64_t given, const std::string& here,
                    topology::MeshData& mesh) {
    const auto faces = static_cast<std::int32_t>(given);
    if (faces != given)
        throw InputError(here + ": the " + cut_faces_array(list) + " " + std::to_string(given) +
                         " are not a whole number of 32 bits");
    if (mesh.further_cut_faces.size() < list) mesh.further_cut_faces.resize(list);
    mesh.cut_faces.resize(mesh.num_cells());
    for (auto& further : mesh.further_cut_faces) further.resize(mesh.num_cells());
    (list == 0 ? mesh.cut_faces : mesh.further_cut_faces[list - 1]).back() = faces;
}

}  // namespace

std::optional<CellKind> kind_of_vtk_cell(std::int64_t type) {
    for (int k = 0; k <= topology::num_cell_kinds; ++k)
        if (const auto kind = static_cast<CellKind>(k); vtk_cell_type(kind) == type) return kind;
    return std::nullopt;
}

void refuse_missing_vectors(const std::string& location, const std::string& name,
                            const std::vector<std::string>& others) {
    throw InputError(location + ": has no cell array " + in_quotes(name) + " of three components" +
                     (others.empty()
                          ? ", nor another; add it to the file's cell data"
                          : "; its cell arrays of three components: " + quoted_list(others)));
}

void refuse_missing_regions(const std::string& location, const std::string& name,
                            const std::vector<std::string>& others) {
    throw InputError(
        location + ": has no cell array " + in_quotes(name) + " to take the regions from" +
        (others.empty() ? ", nor another of whole numbers; without a name all regions are 0"
                        : "; its cell arrays of whole numbers: " + quoted_list(others)));
}

std::string remedy_for_dataset(std::string_view kind) {
    if (kind == "polydata")
        return ", a surface; save it as STL, PLY, OFF or OBJ, and make tetrahedra of it by "
               "`incise mesh`";
    if (kind == "structured_points" || kind == "imagedata")
        return ", an image; save a segmentation as NIfTI, MetaImage or NRRD, and make a mesh of it "
               "by `incise mesh`";
    return "; only UNSTRUCTURED_GRID, in XML UnstructuredGrid, holds volume cells";
}

CellCollector make_vtk_collector(const std::string& file, const ReadOptions& options) {
    return {file, "VTK cell type", options};
}

void check_offsets(const std::vector<std::int64_t>& offsets, const std::string& location) {
    if (offsets.empty() || offsets.front() != 0)
        throw InputError(location + ": the offsets of the cells do not begin with 0");
    for (std::size_t i = 1; i < offsets.size(); ++i)
        if (offsets[i] < offsets[i - 1])
            throw InputError(location + ": cell " + std::to_string(i - 1) + ": ends at offset " +
                             std::to_string(offsets[i]) + ", before it begins at " +
                             std::to_string(offsets[i - 1]) + "; offsets must ascend");
}

void append_piece(const VtkPiece& piece, const std::string& location, MeshFile& file,
                  CellCollector& collector) {
    topology::MeshData& mesh = file.mesh;
    mesh.points_may_coincide =
        mesh.points_may_coincide || piece.is_frame || !piece.carriers.empty();
    const auto first_point = static_cast<std::int64_t>(mesh.points.size());
    const auto num_points = static_cast<std::int64_t>(piece.coordinates.size() / 3);
    mesh.points.reserve(mesh.points.size() + piece.coordinates.size() / 3);
    for (std::size_t i = 0; i + 2 < piece.coordinates.size(); i += 3)
        mesh.points.emplace_back(piece.coordinates[i], piece.coordinates[i + 1],
                                 piece.coordinates[i + 2]);

    const auto first_cell = static_cast<std::int64_t>(mesh.num_cells() + collector.num_ignored());
    std::vector<std::int64_t> nodes;
    for (std::size_t c = 0; c < piece.types.size(); ++c) {
        const auto here = [&] { return location + ": cell " + std::to_string(c); };
        const auto* form = find_form(forms, piece.types[c]);
        if (form == nullptr)
            throw InputError(here() + ": cell type " + std::to_string(piece.types[c]) +
                             " is not one of VTK's; export linear elements");
        if (collector.refuses(*form)) collector.refuse(*form, here());
        const auto begin = static_cast<std::size_t>(piece.offsets[c]);
        const auto size = static_cast<std::size_t>(piece.offsets[c + 1]) - begin;
        if (form->num_nodes != 0 && size != static_cast<std::size_t>(form->num_nodes))
            throw InputError(here() + ": a " + form->name + " has " +
                             std::to_string(form->num_nodes) + " nodes, this one has " +
                             std::to_string(size));
        if (form->use == ignore) {
            collector.ignore(*form);
            continue;
        }
        if (size < CellCollector::num_corners_of(*form))
            throw InputError(here() + ": a " + form->name + " has at least " +
                             std::to_string(CellCollector::num_corners_of(*form)) +
                             " nodes, this one has " + std::to_string(size));
        nodes.resize(size);
        for (std::size_t i = 0; i < size; ++i) {
            const auto node = piece.connectivity[begin + i];
            if (node < 0 || node >= num_points)
                throw InputError(here() + ": node index " + std::to_string(node) +
                                 " is out of range (" + std::to_string(num_points) + " points)");
            nodes[i] = first_point + node;
            if (!mesh.points[static_cast<std::size_t>(nodes[i])].allFinite())
                throw InputError(here() + ": its node " + std::to_string(node) +
                                 " has a coordinate that is not finite");
        }
        const auto region =
            piece.regions.empty() ? std::optional(0) : whole_number(piece.regions[c]);
        if (!region)
            throw InputError(here() + ": region " + shown(piece.regions[c]) +
                             " is not a whole number of 32 bits; name another array as the "
                             "region array");
        const std::int64_t number = first_cell + static_cast<std::int64_t>(c);
        if (form->kind == CellKind::polyhedron) {
            keep_polyhedron(piece, c, first_point, nodes, *region, here(), mesh);
            mesh.source_cells.push_back(number);
        } else {
            collector.keep(*form, number, nodes, *region, mesh);
        }
        if (!piece.carriers.empty()) mesh.carriers.of_cell.push_back(piece.carriers[c]);
        for (std::size_t k = 0; k < piece.cut_faces.size(); ++k)
            if (!piece.cut_faces[k].empty() && piece.cut_faces[k][c] != 0)
                keep_cut_faces(k, piece.cut_faces[k][c], here(), mesh);
        for (const auto& [name, values] : piece.vectors)
            file.cell_vectors[name].emplace_back(values.data() + 3 * c);
    }
    if (!mesh.cut_faces.empty()) mesh.cut_faces.resize(mesh.num_cells());
    for (auto& further : mesh.further_cut_faces) further.resize(mesh.num_cells());
}

}  // namespace incise::io
