// incise.Mesh, incise.read_mesh and incise.cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/mesh.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "incise/app/geometric_cut.h"
#include "incise/base/error.h"
#include "incise/cutting/exact/undividable.h"
#include "incise/cutting/surfaces/surface_check.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/io/mesh/mesh_writer.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/python/cell_arrays.h"
#include "incise/python/handle.h"
#include "incise/scenario/tool_build.h"
#include "incise/topology/box_mesh.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"
#include "incise/topology/mesh_metrics.h"
#include "incise/topology/mesh_repair.h"

namespace incise::python {

namespace {

using topology::CellKind;
using topology::MeshData;
using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;

/// Returns an array of whole numbers. Throws TypeError that names it for others.
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

/// Appends cells that all have the same number of corners, which tells their kind.
void append_cells(MeshData& mesh, const py::handle& cells, const std::optional<Integers>& regions,
                  const std::string& name, std::optional<CellKind> kind) {
    const Integers corners = integers_from(cells, name);
    if (corners.ndim() != 2) throw InputError(name + " must have the shape (M, 4) or (M, 8)");
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
    const py::gil_scoped_release release;
    return checked(topology::box_mesh(
        element == "tet" ? CellKind::tetrahedron : CellKind::hexahedron, low, lengths, bricks));
}

PyMesh read_mesh(const py::object& path, const std::string& region_array, bool linear, bool weld) {
    const std::filesystem::path file = path_from(path);
    PyMesh mesh;
    {
        const py::gil_scoped_release release;
        io::MeshFile read =
            io::read_mesh(file, {.region_array = region_array,
                                 .linear = linear,
                                 .linear_advice = "read them by their corners with linear=True"});
        if (weld) read.warnings.push_back(topology::weld_report(topology::weld(read.mesh)));
        const auto check = topology::check(
            read.mesh, {.join = "join them with weld=True", .keep = "leave weld out"});
        std::string text;
        for (const std::string& error : check.errors)
            text += (text.empty() ? "" : "\n") + file.string() + ": " + error;
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
    for (std::size_t c = 0; c < mesh.data->num_cells(); ++c) {
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

// --- Cuts

/// The result of cut().
struct CutResult {
    PyMesh mesh;
    app::GeometricCutReport report;
};

Vec3 part_of(const py::handle& pair, std::size_t index, const std::string& name) {
    const auto parts = py::reinterpret_borrow<py::sequence>(pair);
    return vector_from(py::object(parts[index]), name);
}

/// Throws InputError unless the object is a sequence of `size` parts.
void require_parts(const py::handle& object, std::size_t size, const std::string& name,
                   const std::string& form) {
    if (!py::isinstance<py::sequence>(object) || py::isinstance<py::str>(object) ||
        py::len(object) != size)
        throw InputError(name + " must be " + form);
}

double number_from(const py::handle& pair, std::size_t index, const std::string& name) {
    const auto parts = py::reinterpret_borrow<py::sequence>(pair);
    const double value = PyFloat_AsDouble(py::object(parts[index]).ptr());
    if (value == -1.0 && PyErr_Occurred()) throw py::error_already_set();
    if (!(value > 0.0 && std::isfinite(value))) throw InputError(name + " must be above 0");
    return value;
}

Vec3 finite(const Vec3& v, const std::string& name) {
    if (!v.allFinite()) throw InputError(name + " must be finite");
    return v;
}

topology::SurfaceData surface_from(const py::object& given, const std::string& name) {
    if (!py::isinstance<py::tuple>(given) && !py::isinstance<py::list>(given)) {
        io::SurfaceFile file = io::read_surface(path_from(given));
        for (const std::string& defect : cutting::defects_of_surface(file.surface))
            file.warnings.push_back(defect);
        for (const std::string& warning : file.warnings) pass_warning(name + ": " + warning);
        return std::move(file.surface);
    }
    require_parts(given, 2, name, "a file, or a pair of points and triangles");
    const auto parts = py::reinterpret_borrow<py::sequence>(given);
    topology::SurfaceData surface;
    surface.points = points_from(py::object(parts[0]), name + ": points");
    for (const Vec3& x : surface.points) finite(x, name + ": points");
    const Integers triangles = integers_from(py::object(parts[1]), name + ": triangles");
    if (triangles.ndim() != 2 || triangles.shape(1) != 3 || triangles.shape(0) == 0)
        throw InputError(name + ": triangles must have the shape (T, 3)");
    for (py::ssize_t t = 0; t < triangles.shape(0); ++t) {
        std::array<std::int64_t, 3> corners{};
        for (py::ssize_t k = 0; k < 3; ++k) {
            corners[static_cast<std::size_t>(k)] = triangles.at(t, k);
            if (triangles.at(t, k) < 0 ||
                triangles.at(t, k) >= static_cast<std::int64_t>(surface.points.size()))
                throw InputError(name + ": triangle " + std::to_string(t) + ": there is no point " +
                                 std::to_string(triangles.at(t, k)));
        }
        surface.triangles.push_back(corners);
    }
    return surface;
}

app::SweepCut sweep_from(const py::object& given, const std::string& name) {
    const auto poses =
        py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!poses || poses.ndim() != 3 || poses.shape(0) < 2 || poses.shape(1) < 2 ||
        poses.shape(2) != 3) {
        PyErr_Clear();
        throw InputError(name +
                         " must have the shape (P, K, 3): at least two poses of the edge of at "
                         "least two points");
    }
    app::SweepCut sweep;
    for (py::ssize_t p = 0; p < poses.shape(0); ++p) {
        sweep.poses.emplace_back();
        for (py::ssize_t k = 0; k < poses.shape(1); ++k)
            sweep.poses.back().push_back(
                finite({poses.at(p, k, 0), poses.at(p, k, 1), poses.at(p, k, 2)}, name));
    }
    return sweep;
}

std::vector<app::CutTool> tools_from(const py::sequence& planes, const py::sequence& surfaces,
                                     const py::sequence& sweeps, const py::sequence& spheres,
                                     const py::sequence& boxes, const py::sequence& capsules) {
    std::vector<app::CutTool> tools;
    const auto for_each = [&](const py::sequence& list, const std::string& kind, auto make) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string name = kind + "[" + std::to_string(i) + "]";
            tools.push_back({name, make(py::object(list[i]), name)});
        }
    };
    using Kind = decltype(app::CutTool::kind);
    for_each(planes, "planes", [](const py::object& plane, const std::string& name) -> Kind {
        require_parts(plane, 2, name, "a pair of a point and a normal");
        const Vec3 normal = finite(part_of(plane, 1, name), name);
        if (normal.isZero(0.0)) throw InputError(name + " has a normal of zero length");
        return app::PlaneCut{finite(part_of(plane, 0, name), name), normal};
    });
    for_each(surfaces, "surfaces", [](const py::object& surface, const std::string& name) -> Kind {
        return app::SurfaceCut{surface_from(surface, name)};
    });
    for_each(sweeps, "sweeps", [](const py::object& sweep, const std::string& name) -> Kind {
        return sweep_from(sweep, name);
    });
    for_each(
        spheres, "remove_spheres", [](const py::object& ball, const std::string& name) -> Kind {
            require_parts(ball, 2, name, "a pair of a centre and a radius");
            return app::ShapeRemoval{cutting::Sphere{number_from(ball, 1, name + ": the radius")},
                                     finite(part_of(ball, 0, name), name)};
        });
    for_each(boxes, "remove_boxes", [](const py::object& corners, const std::string& name) -> Kind {
        require_parts(corners, 2, name, "a pair of the lower and the upper corner");
        const Vec3 low = finite(part_of(corners, 0, name), name);
        const Vec3 high = finite(part_of(corners, 1, name), name);
        if (!(low.array() < high.array()).all())
            throw InputError(name + ": the lower corner comes first");
        return app::ShapeRemoval{cutting::Cuboid{high - low}, 0.5 * (low + high)};
    });
    for_each(capsules, "remove_capsules",
             [](const py::object& capsule, const std::string& name) -> Kind {
                 require_parts(capsule, 3, name, "two points and a radius");
                 const Vec3 from = finite(part_of(capsule, 0, name), name);
                 const Vec3 to = finite(part_of(capsule, 1, name), name);
                 const Vec3 middle = 0.5 * (from + to);
                 return app::ShapeRemoval{
                     cutting::Capsule{from - middle, to - middle,
                                      number_from(capsule, 2, name + ": the radius")},
                     middle};
             });
    return tools;
}

CutResult cut(const std::shared_ptr<PyMesh>& given, const py::sequence& planes,
              const py::sequence& surfaces, const py::sequence& sweeps, const py::sequence& spheres,
              const py::sequence& boxes, const py::sequence& capsules,
              const std::optional<std::string>& mode, double snap) {
    if (!given) throw py::type_error("mesh must be an incise.Mesh");
    if (mode && *mode != "split" && *mode != "separate")
        throw InputError("mode is '" + *mode + "': it must be 'split' or 'separate'");
    if (!(snap >= 0.0 && snap <= 0.5)) throw InputError("snap must be from 0 to 0.5");
    const std::vector<app::CutTool> tools =
        tools_from(planes, surfaces, sweeps, spheres, boxes, capsules);
    if (tools.empty())
        throw InputError(
            "no tool is given: use planes, surfaces, sweeps, remove_spheres, "
            "remove_boxes or remove_capsules");
    const PyMesh& mesh = *given;
    CutResult result;
    {
        const py::gil_scoped_release release;
        try {
            topology::BuiltMesh built = topology::Mesh::build(*mesh.data);
            const auto usual = scenario::usual_mode(built.mesh);
            const auto chosen = !mode              ? usual
                                : *mode == "split" ? cutting::CutMode::split
                                                   : cutting::CutMode::separate;
            result.report = app::geometric_cut(built.mesh, tools, {chosen, snap});
            MeshData cut = topology::to_mesh_data(built.mesh, built.mesh.rest_positions());
            cut.carriers = std::move(result.report.carriers);
            cut.points_may_coincide =
                mesh.data->points_may_coincide || result.report.total.nodes_duplicated > 0;
            result.mesh = {std::make_shared<const MeshData>(std::move(cut)),
                           result.report.warnings};
        } catch (const cutting::UndividableElement& error) {
            throw InputError(std::string(error.what()) + "; use mode='separate'");
        }
    }
    for (const std::string& warning : result.mesh.warnings) pass_warning(warning);
    return result;
}

py::dict report_of(const CutResult& result) {
    const app::CutCounts& total = result.report.total;
    py::dict report;
    report["pieces"] = [&] {
        py::list pieces;
        for (const app::Piece& piece : result.report.pieces) {
            py::dict row;
            row["volume"] = piece.volume;
            row["elements"] = piece.elements;
            pieces.append(row);
        }
        return pieces;
    }();
    report["crossed"] = total.elements_crossed;
    report["snapped"] = total.nodes_snapped;
    report["elements_added"] = total.elements_added;
    report["elements_removed"] = total.elements_removed;
    report["nodes_added"] = total.nodes_added;
    report["nodes_duplicated"] = total.nodes_duplicated;
    report["faces_opened"] = total.faces_opened;
    report["cut_area"] = total.cut_area;
    report["volume_removed"] = total.volume_removed;
    report["volume_error"] = result.report.volume_error();
    return report;
}

void register_cut(py::module_& module) {
    py::class_<CutResult, std::shared_ptr<CutResult>> type(module, "CutResult",
                                                           "The result of incise.cut().");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its mesh");
    type.def_property_readonly(
            "mesh", held(+[](const CutResult& result) { return result.mesh; }),
            "The mesh after the cuts, an incise.Mesh. The two sides of a cut have points of their\n"
            "own at the same positions.")
        .def_property_readonly("report", held(&report_of),
                               R"(What was done, a dict with names as in `incise cut --json`.

pieces: list of dicts with volume, m3, and elements, the largest first.
crossed, snapped, elements_added, elements_removed, nodes_added, nodes_duplicated, faces_opened:
whole numbers.  cut_area: of one side, m2.  volume_removed: m3.
volume_error: relative change of the volume besides what was removed.)");
    module.def("cut", &cut, py::arg("mesh"), py::kw_only(), py::arg("planes") = py::tuple(),
               py::arg("surfaces") = py::tuple(), py::arg("sweeps") = py::tuple(),
               py::arg("remove_spheres") = py::tuple(), py::arg("remove_boxes") = py::tuple(),
               py::arg("remove_capsules") = py::tuple(), py::arg("mode") = py::none(),
               py::arg("snap") = cutting::default_snap,
               R"(Cut a mesh at rest, without dynamics, and return a CutResult.

mesh: an incise.Mesh, which does not change.
planes: list of pairs (point, normal), three numbers each; a normal has any length above 0.
surfaces: list of files (STL, PLY, OFF, OBJ) or of pairs (points (P, 3), triangles (T, 3)).
sweeps: list of arrays (P, K, 3): the K points of a blade's edge in P poses, moved straight between.
remove_spheres, remove_boxes, remove_capsules: lists of (centre, radius), (low corner, high corner)
    and (from, to, radius): remove the elements whose centres they cover.
mode: 'split' divides elements, 'separate' opens the faces between them. None: 'split' if all
    elements are tetrahedra.
snap: points of edges nearer than this part of the edge to a node are taken as on it, 0 to 0.5.

Tools act in this order, all lengths in the unit of the mesh. Raises InputError for tools that
cannot be, for elements that cannot be divided, and if nothing is left.

>>> block = incise.Mesh.box([0.1, 0.1, 0.1], [2, 2, 2])
>>> result = incise.cut(block, planes=[([0.03, 0, 0], [1, 0, 0])])
>>> len(result.report["pieces"])
2)");
}

}  // namespace

void register_mesh(py::module_& module) {
    py::class_<PyMesh, std::shared_ptr<PyMesh>> type(
        module, "Mesh", R"(A mesh of a body at rest. It does not change.

Cells are tetrahedra (4 corners), hexahedra (8), wedges (6) and pyramids (5), with their corners in
the order of VTK. Lengths are metres if the mesh is for a World.

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
    the keys tetrahedron, hexahedron, wedge and pyramid.
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
            "Whole numbers, rows of points: shape (M, 4) or (M, 8), a copy. Of several kinds a\n"
            "dict of such arrays with the keys tetrahedron, hexahedron, wedge and pyramid.")
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
                 const std::filesystem::path file = path_from(path);
                 const py::gil_scoped_release release;
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
    register_cut(module);
}

}  // namespace incise::python
