// incise.Mesh and incise.read_mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/python/cell_arrays.h"
#include "incise/python/handle.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/mesh_repair.h"

namespace incise::python {

namespace {

using topology::CellKind;
using topology::MeshData;

/// Appends cells that all have the same number of corners, which tells their kind.
void append_cells(MeshData& mesh, const py::handle& cells, const std::optional<Integers>& regions,
                  const std::string& name, std::optional<CellKind> kind) {
    const Integers corners = integers_from(cells, name);
    if (corners.ndim() != 2)
        throw InputError(name + " must have the shape (M, 4), (M, 5), (M, 6) or (M, 8)");
    if (!kind)
        for (std::size_t k = 0; k < topology::num_cell_kinds; ++k)
            if (topology::cell_traits[k].num_corners == corners.shape(1))
                kind = static_cast<CellKind>(k);
    if (!kind || topology::traits(*kind).num_corners != corners.shape(1))
        throw InputError(name + " has " + std::to_string(corners.shape(1)) +
                         " corners a cell: tetrahedra have 4, pyramids 5, wedges 6, hexahedra 8");
    if (regions && (regions->ndim() != 1 || regions->shape(0) != corners.shape(0)))
        throw InputError("regions must have one number for each of the " +
                         std::to_string(corners.shape(0)) + " cells");
    for (py::ssize_t c = 0; c < corners.shape(0); ++c) {
        const std::int64_t region = regions ? regions->at(c) : 0;
        if (region != static_cast<int>(region))
            throw InputError("region " + std::to_string(region) + " is out of range");
        mesh.add_cell(*kind, {corners.data(c, 0), static_cast<std::size_t>(corners.shape(1))},
                      static_cast<int>(region));
    }
}

std::optional<CellKind> kind_named(const std::string& name) {
    for (std::size_t k = 0; k < topology::num_cell_kinds; ++k)
        if (name == topology::cell_traits[k].name) return static_cast<CellKind>(k);
    return std::nullopt;
}

PyMesh checked(MeshData mesh) {
    topology::MeshCheck check = topology::check(mesh);
    if (!check.errors.empty()) {
        std::string text;
        for (const std::string& error : check.errors) text += (text.empty() ? "" : "\n") + error;
        throw InputError(text);
    }
    return {std::make_shared<const MeshData>(std::move(mesh)), std::move(check.warnings)};
}

PyMesh mesh_from(const py::object& points, const py::object& cells, const py::object& regions) {
    MeshData mesh;
    mesh.points = points_from(points, "points");
    if (py::isinstance<py::dict>(cells)) {
        if (!regions.is_none() && !py::isinstance<py::dict>(regions))
            throw py::type_error("regions must be a dict by kind, as cells is one");
        for (const auto& [key, value] : py::reinterpret_borrow<py::dict>(cells)) {
            const auto name = key.cast<std::string>();
            const auto kind = kind_named(name);
            if (!kind)
                throw InputError("cells: there is no kind '" + name +
                                 "'; known are tetrahedron, hexahedron, wedge and pyramid");
            std::optional<Integers> of_kind;
            if (!regions.is_none() && regions.contains(key))
                of_kind = integers_from(regions[key], "regions");
            append_cells(mesh, value, of_kind, "cells['" + name + "']", kind);
        }
    } else {
        append_cells(
            mesh, cells,
            regions.is_none() ? std::nullopt : std::optional(integers_from(regions, "regions")),
            "cells", {});
    }
    return checked(std::move(mesh));
}

PyMesh box(const py::object& size, const py::object& cells, const std::string& element,
           const py::object& origin) {
    const Vec3 lengths = vector_from(size, "size"), low = vector_from(origin, "origin");
    const Integers numbers = integers_from(cells, "cells");
    if (numbers.ndim() != 1 || numbers.shape(0) != 3)
        throw InputError("cells must be three whole numbers");
    std::array<int, 3> bricks{};
    constexpr double most_elements = 1e8;
    double elements = 6.0;
    for (py::ssize_t i = 0; i < 3; ++i) {
        if (numbers.at(i) < 1)
            throw InputError("cells must be three whole numbers, each at least 1");
        elements *= static_cast<double>(numbers.at(i));
        bricks[static_cast<std::size_t>(i)] = static_cast<int>(numbers.at(i));
    }
    if (elements > most_elements) throw InputError("a box of so many cells is too large");
    if (!(lengths.minCoeff() > 0.0 && lengths.allFinite() && low.allFinite()))
        throw InputError("size must be three lengths above 0, and origin finite");
    if (element != "tet" && element != "hex")
        throw InputError("element is '" + element + "': it must be 'tet' or 'hex'");
    const Unlocked unlocked;
    return checked(topology::box_mesh(
        element == "tet" ? CellKind::tetrahedron : CellKind::hexahedron, low, lengths, bricks));
}

PyMesh read_mesh(const py::object& path, const std::string& region_array, bool linear, bool weld) {
    const std::filesystem::path file = file_from(path, "path", "mesh file");
    PyMesh mesh;
    {
        const Unlocked unlocked;
        io::MeshFile read =
            io::read_mesh(file, {.region_array = region_array,
                                 .linear = linear,
                                 .linear_advice = "read them by their corners with linear=True"});
        if (weld) read.warnings.push_back(topology::weld_report(topology::weld(read.mesh)));
        const auto check = topology::check(
            read.mesh, {.join = "join them with weld=True", .keep = "leave weld out"});
        std::string text;
        for (const std::string& error : check.errors) {
            if (!text.empty()) text += '\n';
            text.append(file.string()).append(": ").append(error);
        }
        if (!text.empty()) throw InputError(text);
        read.warnings.insert(read.warnings.end(), check.warnings.begin(), check.warnings.end());
        for (const std::string& warning : read.warnings)
            mesh.warnings.push_back(file.string() + ": " + warning);
        mesh.data = std::make_shared<const MeshData>(std::move(read.mesh));
    }
    for (const std::string& warning : mesh.warnings) pass_warning(warning);
    return mesh;
}

py::object cells_of(const PyMesh& mesh) {
    CellArrays cells(true);
    cells.of(CellKind::polyhedron) = mesh.data->faces;
    for (std::size_t c = 0; c < mesh.data->num_cells(); ++c) {
        if (mesh.data->kinds[c] == CellKind::polyhedron) continue;
        const auto corners = mesh.data->cell(c);
        auto& rows = cells.of(mesh.data->kinds[c]);
        rows.insert(rows.end(), corners.begin(), corners.end());
    }
    return cells.object(false);
}

py::object regions_of(const PyMesh& mesh) {
    CellArrays regions(false);
    for (std::size_t c = 0; c < mesh.data->num_cells(); ++c)
        regions.of(mesh.data->kinds[c]).push_back(mesh.data->regions[c]);
    return regions.object(false);
}

}  // namespace

Integers integers_from(const py::handle& object, const std::string& name) {
    const py::array given = py::array::ensure(object);
    if (!given ||
        (given.size() > 0 && given.dtype().kind() != 'i' && given.dtype().kind() != 'u')) {
        PyErr_Clear();
        throw py::type_error(name + " must be whole numbers");
    }
    Integers array = Integers::ensure(given);
    if (!array) throw py::error_already_set();
    return array;
}

void register_mesh(py::module_& module) {
    py::class_<PyMesh, std::shared_ptr<PyMesh>> type(
        module, "Mesh", R"(A mesh of a body at rest. It does not change.

Cells are tetrahedra (4 corners), hexahedra (8), wedges (6) and pyramids (5), with their corners in
the order of VTK. A mesh of cut() and of read_mesh() can also have polyhedra. Lengths are metres if
the mesh is for a World.

>>> mesh = incise.Mesh.box([0.2, 0.1, 0.1], [4, 2, 2])
>>> mesh.points.shape, mesh.cells.shape
((45, 3), (96, 4))
>>> round(mesh.volume, 6)
0.002)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its points, cells and regions");
    type.def(py::init(&mesh_from), py::arg("points"), py::arg("cells"),
             py::arg("regions") = py::none(), R"(points: shape (N, 3).
cells: whole numbers, shape (M, 4), (M, 5), (M, 6) or (M, 8); of several kinds a dict by kind, with
    the keys tetrahedron, hexahedron, wedge and pyramid. Polyhedra come of cut() and read_mesh().
regions: one whole number a cell, (M,), or a dict as cells; None: all 0. Materials refer to them.
Raises InputError with all faults of the mesh: cells without volume or turned inside out, indices
out of range, faces that more than two cells share.)")
        .def_static("box", &box, py::arg("size"), py::arg("cells"), py::arg("element") = "tet",
                    py::arg("origin") = py::make_tuple(0.0, 0.0, 0.0),
                    R"(Return a mesh of a box, divided into bricks.

size: the three edge lengths.  cells: numbers of bricks along x, y and z.
element: 'tet' divides each brick into six tetrahedra, 'hex' makes it a hexahedron.
origin: the lowest corner.)")
        .def_property_readonly(
            "points", held(+[](const PyMesh& mesh) { return matrix_of(mesh.data->points); }),
            "The points at rest, shape (N, 3), a copy.")
        .def_property_readonly(
            "cells", held(&cells_of),
            "Whole numbers, rows of points: shape (M, 4), (M, 5), (M, 6) or (M, 8), a copy. Of\n"
            "several kinds a dict of such arrays with the keys tetrahedron, hexahedron, wedge and\n"
            "pyramid. Polyhedra, which cuts leave, are in one list under the key polyhedron: for\n"
            "each the number of its faces, then for each face the number of its points and its\n"
            "points.")
        .def_property_readonly(
            "regions", held(&regions_of),
            "The region of each cell, shape (M,), a copy; a dict if cells is one.")
        .def_property_readonly("num_points",
                               held(+[](const PyMesh& mesh) { return mesh.data->points.size(); }),
                               "Number of points.")
        .def_property_readonly("num_cells",
                               held(+[](const PyMesh& mesh) { return mesh.data->num_cells(); }),
                               "Number of cells of all kinds.")
        .def_property_readonly("volume", held(+[](const PyMesh& mesh) {
                                   return topology::measure(*mesh.data).volume;
                               }),
                               "The volume of all cells.")
        .def_property_readonly("surface_area", held(+[](const PyMesh& mesh) {
                                   return topology::measure(*mesh.data).surface_area;
                               }),
                               "The area of the faces that belong to one cell only.")
        .def_property_readonly("bounding_box", held(+[](const PyMesh& mesh) {
                                   const auto metrics = topology::measure(*mesh.data);
                                   return matrix_of(std::array{metrics.box_min, metrics.box_max});
                               }),
                               "The lowest and the highest corner, shape (2, 3).")
        .def_property_readonly(
            "quality", held(+[](const PyMesh& mesh) {
                const auto metrics = topology::measure(*mesh.data);
                py::dict quality;
                quality["min_altitude"] = metrics.min_altitude;
                quality["min_dihedral_angle"] = metrics.min_dihedral_angle;
                quality["edge_length"] = py::make_tuple(
                    metrics.min_edge_length, metrics.mean_edge_length, metrics.max_edge_length);
                return quality;
            }),
            "A dict: min_altitude, the least altitude of all cells; min_dihedral_angle, the least\n"
            "angle between two faces of a cell, rad; edge_length, a tuple (min, mean, max).")
        .def_property_readonly("warnings", held(&PyMesh::warnings),
                               "What is unusual about the mesh: a list of sentences.")
        .def("write", held(+[](const PyMesh& mesh, const py::object& path) {
                 const std::filesystem::path file = file_from(path, "path", "mesh file");
                 const Unlocked unlocked;
                 io::write_mesh(file, *mesh.data);
             }),
             py::arg("path"), R"(Write the mesh to a file.

path: its ending is the format: .vtu, .vtk, .msh, .mesh, .inp or .usda.
Raises InputError for another ending, OutputError if the file cannot be written.)")
        .def("__repr__", held(+[](const PyMesh& mesh) {
                 return "<incise.Mesh: " + std::to_string(mesh.data->points.size()) + " points, " +
                        std::to_string(mesh.data->num_cells()) + " cells>";
             }),
             "Return the size of the mesh as text.");

    module.def("read_mesh", &read_mesh, py::arg("path"), py::kw_only(),
               py::arg("region_array") = std::string(io::ReadOptions::usual_region_array),
               py::arg("linear") = false, py::arg("weld") = false,
               R"(Read a mesh from a file and return it as a Mesh.

path: VTU, legacy VTK, Gmsh, MEDIT, TetGen, Abaqus, FEBio or USD; the contents tell the format.
region_array: the cell array of a VTK file that becomes the regions.
linear: True reads cells of second order by their corners; otherwise they are refused.
weld: True joins points at the same position.
Raises InputError with all faults of the file. What is unusual becomes an InciseWarning.)");
}

}  // namespace incise::python
