// incise.cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "incise/base/error.h"
#include "incise/cutting/rest/cut_at_rest.h"
#include "incise/cutting/surfaces/surface_check.h"
#include "incise/io/surface/surface_reader.h"
#include "incise/python/handle.h"
#include "incise/python/mesh.h"
#include "incise/topology/mesh.h"

namespace incise::python {

namespace {

using topology::MeshData;

/// The result of cut().
struct CutResult {
    PyMesh mesh;
    cutting::RestCutReport report;
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
        io::SurfaceFile file = io::read_surface(file_from(given, name, "surface file"));
        for (const std::string& defect : cutting::defects_of_surface(file.surface))
            file.warnings.push_back(defect);
        const std::string prefix = name + ": ";
        for (const std::string& warning : file.warnings) pass_warning(prefix + warning);
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

cutting::Sweep sweep_from(const py::object& given, const std::string& name, double snap) {
    const auto poses =
        py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
    if (!poses || poses.ndim() != 3 || poses.shape(0) < 2 || poses.shape(1) < 2 ||
        poses.shape(2) != 3) {
        PyErr_Clear();
        throw InputError(name +
                         " must have the shape (P, K, 3): at least two poses of the edge of at "
                         "least two points");
    }
    cutting::Sweep sweep{{}, snap};
    for (py::ssize_t p = 0; p < poses.shape(0); ++p) {
        sweep.poses.emplace_back();
        for (py::ssize_t k = 0; k < poses.shape(1); ++k)
            sweep.poses.back().push_back(
                finite({poses.at(p, k, 0), poses.at(p, k, 1), poses.at(p, k, 2)}, name));
    }
    return sweep;
}

std::vector<cutting::RestTool> tools_from(const py::sequence& planes, const py::sequence& surfaces,
                                          const py::sequence& sweeps, const py::sequence& spheres,
                                          const py::sequence& boxes, const py::sequence& capsules,
                                          double snap) {
    std::vector<cutting::RestTool> tools;
    const auto for_each = [&](const py::sequence& list, const std::string& kind, auto make) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            const std::string name = kind + "[" + std::to_string(i) + "]";
            tools.push_back({name, make(py::object(list[i]), name)});
        }
    };
    using Kind = decltype(cutting::RestTool::kind);
    for_each(planes, "planes", [&](const py::object& plane, const std::string& name) -> Kind {
        require_parts(plane, 2, name, "a pair of a point and a normal");
        const Vec3 normal = finite(part_of(plane, 1, name), name);
        if (normal.isZero(0.0)) throw InputError(name + " has a normal of zero length");
        return cutting::PlaneCut{finite(part_of(plane, 0, name), name), normal, snap};
    });
    for_each(surfaces, "surfaces", [&](const py::object& surface, const std::string& name) -> Kind {
        return cutting::SurfaceCut{surface_from(surface, name), snap};
    });
    for_each(sweeps, "sweeps", [&](const py::object& sweep, const std::string& name) -> Kind {
        return sweep_from(sweep, name, snap);
    });
    for_each(
        spheres, "remove_spheres", [](const py::object& ball, const std::string& name) -> Kind {
            require_parts(ball, 2, name, "a pair of a centre and a radius");
            return cutting::Removal{cutting::Sphere{number_from(ball, 1, name + ": the radius")},
                                    finite(part_of(ball, 0, name), name)};
        });
    for_each(boxes, "remove_boxes", [](const py::object& corners, const std::string& name) -> Kind {
        require_parts(corners, 2, name, "a pair of the lower and the upper corner");
        const Vec3 low = finite(part_of(corners, 0, name), name);
        const Vec3 high = finite(part_of(corners, 1, name), name);
        if (!(low.array() < high.array()).all())
            throw InputError(name + ": the lower corner comes first");
        return cutting::Removal{cutting::Cuboid{high - low}, 0.5 * (low + high)};
    });
    for_each(capsules, "remove_capsules",
             [](const py::object& capsule, const std::string& name) -> Kind {
                 require_parts(capsule, 3, name, "two points and a radius");
                 const Vec3 from = finite(part_of(capsule, 0, name), name);
                 const Vec3 to = finite(part_of(capsule, 1, name), name);
                 const Vec3 middle = 0.5 * (from + to);
                 return cutting::Removal{
                     cutting::Capsule{from - middle, to - middle,
                                      number_from(capsule, 2, name + ": the radius")},
                     middle};
             });
    return tools;
}

CutResult cut(const std::shared_ptr<PyMesh>& given, const py::sequence& planes,
              const py::sequence& surfaces, const py::sequence& sweeps, const py::sequence& spheres,
              const py::sequence& boxes, const py::sequence& capsules,
              const std::optional<std::string>& mode, double snap, const py::kwargs& unknown) {
    refuse_unknown(unknown, "cut",
                   {"planes", "surfaces", "sweeps", "remove_spheres", "remove_boxes",
                    "remove_capsules", "mode", "snap"});
    if (!given) throw py::type_error("mesh must be an incise.Mesh");
    if (mode && *mode != "split" && *mode != "separate")
        throw InputError("mode is '" + *mode + "': it must be 'split' or 'separate'");
    if (!(snap >= 0.0 && snap <= 0.5)) throw InputError("snap must be from 0 to 0.5");
    const std::vector<cutting::RestTool> tools =
        tools_from(planes, surfaces, sweeps, spheres, boxes, capsules, snap);
    if (tools.empty())
        throw InputError(
            "no tool is given: use planes, surfaces, sweeps, remove_spheres, "
            "remove_boxes or remove_capsules");
    const PyMesh& mesh = *given;
    CutResult result;
    {
        const Unlocked unlocked;
        topology::BuiltMesh built = topology::Mesh::build(*mesh.data);
        const auto chosen =
            mode == "separate" ? cutting::CutMode::separate : cutting::CutMode::split;
        result.report = cutting::cut_at_rest(built.mesh, tools, chosen);
        MeshData cut = std::move(result.report.mesh);
        cut.points_may_coincide |= mesh.data->points_may_coincide;
        result.mesh = {std::make_shared<const MeshData>(std::move(cut)), result.report.warnings};
    }
    for (const std::string& warning : result.mesh.warnings) pass_warning(warning);
    return result;
}

py::dict report_of(const CutResult& result) {
    const cutting::CutCounts& total = result.report.total;
    py::dict report;
    report["pieces"] = [&] {
        py::list pieces;
        for (const cutting::Piece& piece : result.report.pieces) {
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

}  // namespace

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
mode: 'split' divides elements, 'separate' opens the faces between them. None: 'split'.
snap: points of edges nearer than this part of the edge to a node are taken as on it, 0 to 0.5.

Tools act in this order, all lengths in the unit of the mesh. Raises InputError for tools that
cannot be, for elements that cannot be divided, and if nothing is left.

>>> block = incise.Mesh.box([0.1, 0.1, 0.1], [2, 2, 2])
>>> result = incise.cut(block, planes=[([0.03, 0, 0], [1, 0, 0])])
>>> len(result.report["pieces"])
2)");
}

}  // namespace incise::python
