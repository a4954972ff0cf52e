// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/world_arrays.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/python/cell_arrays.h"

namespace incise::python {

namespace {

/// Returns an object that is made anew if the mesh has changed.
template <class Make>
py::object kept(const World& world, Handle::Kept& kept, Make make_anew) {
    const std::uint64_t version = driver_of(world).topology_version();
    if (kept.version != version) {
        kept.value = make_anew();
        kept.version = version;
    }
    return kept.value;
}

struct Elements {
    py::array_t<double> volumes, centres;
    py::array_t<std::int64_t> regions, components;
    std::uint64_t version;
};

struct Surface {
    py::array_t<std::int64_t> vertices, triangles, regions;
    py::array_t<bool> is_cut;
    std::uint64_t version;
};

struct Physics {
    py::array_t<double> rest_positions, positions, velocities, masses;
    py::object cells, volume_shares, fragments;
};

/// Arrays that show the memory of a world.
class View {
  public:
    explicit View(World world) : world_(std::move(world)) {}
    View(View&&) = delete;
    ~View() {
        if (is_open_) --world_->num_exports;
    }

    void enter() {
        driver_of(world_);
        if (is_open_) throw UsageError("this view is open already");
        ++world_->num_exports;
        is_open_ = true;
    }
    void exit() {
        if (!is_open_) return;
        is_open_ = false;
        --world_->num_exports;
    }
    py::object show(std::span<const Vec3> (*values_of)(const sim::World&)) const {
        if (!is_open_)
            throw UsageError(
                "this view is not open: use it in a with statement, as in "
                "with world.view() as v");
        const std::span<const Vec3> values = values_of(driver_of(world_).world());
        if (!world_->rows().are_ids) return frozen(at_nodes(world_, values));
        struct Export {
            World world;
            explicit Export(World w) : world(std::move(w)) { ++world->num_exports; }
            ~Export() { --world->num_exports; }
            Export(const Export&) = delete;
            Export& operator=(const Export&) = delete;
        };
        auto owner = std::make_unique<Export>(world_);
        const py::capsule base(owner.get(),
                               [](void* pointer) { delete static_cast<Export*>(pointer); });
        static_cast<void>(owner.release());
        return frozen(py::array_t<double>({static_cast<py::ssize_t>(values.size()), py::ssize_t{3}},
                                          values.empty() ? nullptr : values.front().data(), base));
    }

  private:
    World world_;
    bool is_open_ = false;
};

}  // namespace

/// Returns values at the living nodes, in the rows of Python.
py::array_t<double> at_nodes(const World& world, std::span<const Vec3> values) {
    const Handle::Rows& rows = world->rows();
    if (rows.are_ids) return matrix_of(values);
    py::array_t<double> array({static_cast<py::ssize_t>(rows.nodes.size()), py::ssize_t{3}});
    double* out = array.mutable_data();
    for (const VertexId n : rows.nodes)
        for (int c = 0; c < 3; ++c) *out++ = values[n.index()][c];
    return array;
}

py::array_t<double> masses(const World& world) {
    const std::vector<double> all = driver_of(world).world().masses();
    const Handle::Rows& rows = world->rows();
    py::array_t<double> array(
        static_cast<py::ssize_t>(rows.are_ids ? all.size() : rows.nodes.size()));
    double* out = array.mutable_data();
    if (rows.are_ids)
        std::ranges::copy(all, out);
    else
        for (const VertexId n : rows.nodes) *out++ = all[n.index()];
    return array;
}

py::array_t<double> contact_forces(const World& world) {
    const auto forces = driver_of(world).world().contact_forces();
    const Handle::Rows& rows = world->rows();
    py::array_t<double> array(
        {static_cast<py::ssize_t>(world->driver.world().mesh().num_nodes()), py::ssize_t{3}});
    std::fill_n(array.mutable_data(), array.size(), 0.0);
    if (forces)
        for (const auto& [node, force] : *forces)
            if (const std::int64_t row = rows.row(node); row >= 0)
                for (int c = 0; c < 3; ++c) array.mutable_at(row, c) = force[c];
    return array;
}

py::array_t<std::int64_t> node_ids(const World& world) {
    const topology::Mesh& mesh = driver_of(world).world().mesh();
    py::array_t<std::int64_t> array(static_cast<py::ssize_t>(mesh.num_nodes()));
    std::int64_t* out = array.mutable_data();
    for (const VertexId n : mesh.nodes()) *out++ = mesh.label(n);
    return array;
}

namespace {

/// Returns the kind of a cell in arrays: a cell that is as the source has it has its kind there.
topology::CellKind kind_in_arrays(const topology::Mesh& mesh, CellId e) {
    const auto whole = mesh.whole_cell(e);
    return whole ? whole->kind : topology::CellKind::polyhedron;
}

}  // namespace

py::object cells(const World& world) {
    driver_of(world);
    return kept(world, world->cells, [&] {
        const Handle::Rows& rows = world->rows();
        const topology::Mesh& mesh = world->driver.world().mesh();
        CellArrays arrays(true);
        for (const CellId e : mesh.elements()) {
            auto& values = arrays.of(kind_in_arrays(mesh, e));
            if (const auto whole = mesh.whole_cell(e)) {
                for (const VertexId n : whole->corners()) values.push_back(rows.row(n));
                continue;
            }
            values.push_back(mesh.num_faces(e));
            for (int f = 0; f < mesh.num_faces(e); ++f) {
                values.push_back(mesh.face_size({e, f}));
                for (int p = 0; p < mesh.face_size({e, f}); ++p)
                    values.push_back(rows.row(mesh.face_corner({e, f}, p)));
            }
        }
        return arrays.object(true);
    });
}

py::object regions(const World& world) {
    driver_of(world);
    return kept(world, world->regions, [&] {
        const topology::Mesh& mesh = world->driver.world().mesh();
        CellArrays arrays(false);
        for (const CellId e : mesh.elements())
            arrays.of(kind_in_arrays(mesh, e)).push_back(mesh.region(e));
        return arrays.object(true);
    });
}

py::object components(const World& world) {
    driver_of(world);
    return kept(world, world->components, [&] {
        const topology::Mesh& mesh = world->driver.world().mesh();
        const topology::Components components = topology::components(mesh);
        py::array_t<std::int64_t> array(static_cast<py::ssize_t>(mesh.num_nodes()));
        std::int64_t* out = array.mutable_data();
        // The elements at a node hang together through faces there: all are in one component.
        for (const VertexId n : mesh.nodes())
            *out++ = components.of_element[mesh.incident_element(n).index()];
        return frozen(array);
    });
}

py::object elements(const World& world) {
    driver_of(world);
    return kept(world, world->elements, [&] {
        const topology::Mesh& mesh = world->driver.world().mesh();
        const topology::Components components = topology::components(mesh);
        const auto size = static_cast<py::ssize_t>(mesh.num_elements());
        Elements made{py::array_t<double>(size), py::array_t<double>({size, py::ssize_t{3}}),
                      py::array_t<std::int64_t>(size), py::array_t<std::int64_t>(size),
                      world->driver.topology_version()};
        std::array<std::vector<CellId>, topology::num_cell_kinds + 1> by_kind;
        for (const CellId e : mesh.elements())
            by_kind[static_cast<std::size_t>(kind_in_arrays(mesh, e))].push_back(e);
        py::ssize_t row = 0;
        for (const std::vector<CellId>& of_kind : by_kind)
            for (const CellId e : of_kind) {
                const Vec3 centre = cutting::TissueMotion::centre(mesh, e, mesh.rest_positions());
                for (int c = 0; c < 3; ++c) made.centres.mutable_at(row, c) = centre[c];
                made.volumes.mutable_at(row) = topology::rest_volume(mesh, e);
                made.regions.mutable_at(row) = mesh.region(e);
                made.components.mutable_at(row++) = components.of_element[e.index()];
            }
        frozen(made.volumes);
        frozen(made.centres);
        frozen(made.regions);
        frozen(made.components);
        return py::cast(std::move(made));
    });
}

py::object surface(const World& world) {
    driver_of(world);
    return kept(world, world->surface, [&] {
        const Handle::Rows& rows = world->rows();
        sim::World& body = world->driver.world();
        const topology::BoundarySurface& boundary = body.surface();
        const auto size = static_cast<py::ssize_t>(boundary.triangles().size());
        Surface made{{},
                     py::array_t<std::int64_t>({size, py::ssize_t{3}}),
                     py::array_t<std::int64_t>(size),
                     py::array_t<bool>(size),
                     world->driver.topology_version()};
        std::vector<bool> is_on(body.mesh().num_nodes(), false);
        std::int64_t* out = made.triangles.mutable_data();
        for (const auto& triangle : boundary.triangles())
            for (const VertexId n : triangle) {
                *out = rows.row(n);
                is_on[static_cast<std::size_t>(*out++)] = true;
            }
        for (py::ssize_t t = 0; t < size; ++t) {
            const auto triangle = static_cast<std::size_t>(t);
            made.is_cut.mutable_at(t) = boundary.is_cut()[triangle] != 0;
            made.regions.mutable_at(t) = body.mesh().region(boundary.faces()[triangle].cell);
        }
        std::vector<std::int64_t> vertices;
        for (std::size_t i = 0; i < is_on.size(); ++i)
            if (is_on[i]) vertices.push_back(static_cast<std::int64_t>(i));
        made.vertices =
            py::array_t<std::int64_t>(static_cast<py::ssize_t>(vertices.size()), vertices.data());
        frozen(made.vertices);
        frozen(made.triangles);
        frozen(made.is_cut);
        frozen(made.regions);
        return py::cast(std::move(made));
    });
}

namespace {

/// Returns a result of each element as rows. `append` appends the numbers of one.
py::object results(const World& world, std::vector<py::ssize_t> shape,
                   void (*append)(const physics::ElementResult&, std::vector<double>&)) {
    const sim::World& body = driver_of(world).world();
    CellRows<double> rows(false, std::move(shape));
    const std::vector<physics::ElementResult> all = body.cell_results();
    auto result = all.begin();
    for (const CellId e : body.mesh().elements())
        append(*result++, rows.of(kind_in_arrays(body.mesh(), e)));
    return rows.object(false);
}

}  // namespace

py::object stress(const World& world) {
    return results(world, {3, 3}, [](const physics::ElementResult& r, std::vector<double>& row) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) row.push_back(r.cauchy_stress(i, j));
    });
}

py::object volume_ratio(const World& world) {
    return results(world, {}, [](const physics::ElementResult& r, std::vector<double>& row) {
        row.push_back(r.volume_ratio);
    });
}

py::object physics(const World& world) {
    const physics::BodyArrays arrays = driver_of(world).world().body_arrays();
    const topology::MeshData& mesh = arrays.mesh;
    Physics made{
        matrix_of(arrays.rest_positions),
        matrix_of(mesh.points),
        matrix_of(arrays.velocities),
        py::array_t<double>(static_cast<py::ssize_t>(arrays.masses.size()), arrays.masses.data()),
        {},
        {},
        {}};
    // Fragments are counted through the arrays of all kinds.
    CellArrays cells(true), fragments(false);
    CellRows<double> shares(false);
    std::array<std::int64_t, topology::num_cell_kinds + 2> first{};
    for (const topology::CellKind kind : mesh.kinds) ++first[static_cast<std::size_t>(kind) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    std::vector<std::int64_t> number;
    for (std::size_t c = 0; c < mesh.num_cells(); ++c) {
        auto& rows = cells.of(mesh.kinds[c]);
        rows.insert(rows.end(), mesh.cell(c).begin(), mesh.cell(c).end());
        shares.of(mesh.kinds[c]).push_back(arrays.volume_shares[c]);
        number.push_back(first[static_cast<std::size_t>(mesh.kinds[c])]++);
    }
    const topology::Mesh& material = world->driver.world().mesh();
    auto row = arrays.cell_of_element.begin();
    for (const CellId e : material.elements())
        fragments.of(kind_in_arrays(material, e))
            .push_back(number[static_cast<std::size_t>(*row++)]);
    made.cells = cells.object(true);
    made.volume_shares = shares.object(true);
    made.fragments = fragments.object(true);
    for (auto* array : {&made.rest_positions, &made.positions, &made.velocities, &made.masses})
        frozen(*array);
    return py::cast(std::move(made));
}

py::object view(const World& world) {
    driver_of(world);
    return py::cast(std::make_shared<View>(world));
}

void register_elements(py::module_& module) {
    py::class_<Elements, std::shared_ptr<Elements>> type(
        module, "Elements",
        R"(The elements of a body, one row each, whatever their kinds: see World.elements.

Rows are counted through the arrays of World.cells: if that is a dict, row for row as in
numpy.concatenate(list(world.volume_ratio.values())). The arrays are read-only copies: they are
valid for ever, and belong to one topology_version.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "copy its arrays");
    type.def_property_readonly("volumes", held(&Elements::volumes),
                               "The volume of each element at rest, m3. Shape (M,).")
        .def_property_readonly("centres", held(&Elements::centres),
                               "The mean of the corners of each element at rest, m. Shape (M, 3).")
        .def_property_readonly("regions", held(&Elements::regions),
                               "The region of each element, int64. Shape (M,).")
        .def_property_readonly(
            "components", held(&Elements::components),
            "The connected component of each element, numbered as in World.components. Shape (M,).")
        .def_property_readonly("version", held(&Elements::version),
                               "The topology_version that the arrays are for.");
}

void register_surface(py::module_& module) {
    py::class_<Surface, std::shared_ptr<Surface>> type(module, "Surface",
                                                       R"(The surface of a body: see World.surface.

The arrays are read-only copies: they are valid for ever, and belong to one topology_version.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "copy its arrays");
    type.def_property_readonly("vertices", held(&Surface::vertices),
                               "Rows of positions that are on the surface, ascending. Shape (V,).")
        .def_property_readonly(
            "triangles", held(&Surface::triangles),
            "Rows of positions, anticlockwise as seen from outside. Shape (T, 3).")
        .def_property_readonly(
            "is_cut", held(&Surface::is_cut),
            "True for the triangles of cuts, which lay inside at first. Shape (T,).")
        .def_property_readonly("regions", held(&Surface::regions),
                               "The region of the element of each triangle, int64. Shape (T,).")
        .def_property_readonly("version", held(&Surface::version),
                               "The topology_version that the arrays are for.");
}

void register_physics(py::module_& module) {
    py::class_<Physics, std::shared_ptr<Physics>> type(
        module, "Physics",
        R"(The nodes that carry the momentum of a body: see World.physics.

The arrays are read-only copies: they are valid for ever, and show the world as it was.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "copy its arrays");
    type.def_property_readonly("positions", held(&Physics::positions),
                               "The positions of the nodes, m. Shape (P, 3).")
        .def_property_readonly("rest_positions", held(&Physics::rest_positions),
                               "Their positions at rest, m. Shape (P, 3).")
        .def_property_readonly("velocities", held(&Physics::velocities),
                               "Their velocities, m/s. Shape (P, 3).")
        .def_property_readonly("masses", held(&Physics::masses),
                               "The mass that each of them carries, kg. Shape (P,).")
        .def_property_readonly(
            "cells", held(&Physics::cells),
            "The fragments as rows of positions, shape (F, 4) to (F, 8); a dict of such arrays by\n"
            "kind in a mixed mesh. A fragment has the corners of the whole element that it is a\n"
            "part of, so that those of a cut element overlap.")
        .def_property_readonly(
            "volume_shares", held(&Physics::volume_shares),
            "The volume of material that each fragment carries over that of its whole element,\n"
            "shape (F,); a dict by kind if cells is one. Above 0; 1 before any cut.")
        .def_property_readonly(
            "fragments", held(&Physics::fragments),
            "The row of cells that carries each element of World.cells, shape (M,). In a mixed "
            "mesh\n"
            "a dict by the kind of the elements; rows are counted through the arrays of cells.");
}

void register_view(py::module_& module) {
    py::class_<View, std::shared_ptr<View>> type(
        module, "View",
        R"(Arrays that show the memory of a world: see World.view().

They are valid inside the with statement. An array that is kept longer still never dangles: it keeps
the world alive, and step(), run_until(), restore() and undo() raise BufferError until it is gone.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "copy its arrays");
    type.def(
            "__enter__",
            [](const py::object& self) {
                const auto view = self.cast<std::shared_ptr<View>>();
                if (!view) throw py::type_error("None is no view");
                view->enter();
                return self;
            },
            "Open the view.")
        .def(
            "__exit__",
            [](const std::shared_ptr<View>& view, const py::args&) {
                if (view) view->exit();
            },
            "Close the view.")
        .def_property_readonly(
            "positions", held(+[](const View& view) {
                return view.show([](const sim::World& world) { return world.positions(); });
            }),
            "As World.positions, read-only and without a copy. Shape (N, 3), m.")
        .def_property_readonly(
            "velocities", held(+[](const View& view) {
                return view.show([](const sim::World& world) { return world.velocities(); });
            }),
            "As World.velocities, read-only and without a copy. Shape (N, 3), m/s.")
        .def_property_readonly(
            "rest_positions", held(+[](const View& view) {
                return view.show(
                    [](const sim::World& world) { return world.mesh().rest_positions(); });
            }),
            "As World.rest_positions, read-only and without a copy. Shape (N, 3), m.");
}

}  // namespace incise::python
