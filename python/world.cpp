// incise.World, and its surface and views.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/python/cell_arrays.h"
#include "incise/python/handle.h"
#include "incise/python/mesh.h"
#include "incise/python/records.h"
#include "incise/python/tools.h"
#include "incise/python/values.h"
#include "incise/runner/frame_builder.h"
#include "incise/runner/measured_quantities.h"
#include "incise/scenario/body.h"
#include "incise/scenario/body_problems.h"
#include "incise/scenario/scenario_reader.h"

namespace incise::python {

namespace {

// --- Making

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text.append(text.empty() ? "" : "\n").append(line);
    return text;
}

/// Returns the scenario of a report with its warnings. Throws InputError with all its problems and
/// those of the body, as the command line does.
scenario::Scenario sound(scenario::ScenarioReport report, std::vector<std::string>& warnings) {
    if (!report.errors.empty()) {
        try {
            const auto body = scenario::check_body(report.scenario);
            report.errors.insert(report.errors.end(), body.errors.begin(), body.errors.end());
        } catch (const MemoryError& error) {
            report.errors.emplace_back(error.what());
        }
        throw InputError(joined(report.errors));
    }
    warnings = std::move(report.warnings);
    return std::move(report.scenario);
}

/// What a world is made from.
struct Source {
    std::optional<scenario::Value> document;  ///< if not set, `file` is read
    std::filesystem::path file;
    std::vector<std::string> overrides;
    std::shared_ptr<const topology::MeshData> mesh;  ///< in the place of that of the document
    bool is_endless = false;
};

scenario::Entry* find_entry(scenario::Table& table, std::string_view key) {
    const auto found = std::ranges::find(table, key, &scenario::Entry::key);
    return found == table.end() ? nullptr : &*found;
}

void set_entry(scenario::Table& table, const std::string& key, scenario::Value value) {
    if (scenario::Entry* entry = find_entry(table, key))
        entry->value = std::move(value);
    else
        table.push_back({key, {}, std::move(value)});
}

/// Adds what a file must have, but a world in Python need not: an end, and no frames.
void complete(Source& source) {
    auto& root = std::get<scenario::Table>(source.document->data);
    if (!find_entry(root, "output"))
        set_entry(root, "output", {scenario::Table{{"interval", {}, {0.0, {}}}}, {}});
    if (!find_entry(root, "dynamics")) set_entry(root, "dynamics", {scenario::Table(), {}});
    auto* dynamics = std::get_if<scenario::Table>(&find_entry(root, "dynamics")->value.data);
    if (!dynamics || find_entry(*dynamics, "end_time")) return;
    const scenario::Entry* mode = find_entry(*dynamics, "mode");
    const auto* text = mode ? mode->value.get<std::string>() : nullptr;
    // Loads of statics are usually at their full values at 1 s.
    constexpr double never = 1e6;
    set_entry(*dynamics, "end_time", {text && *text == "static" ? 1.0 : never, {}});
    source.is_endless = true;
}

/// Puts the mesh of a scenario into its document: a dict, the name of a file, or an incise.Mesh.
void set_mesh(Source& source, const py::object& mesh) {
    auto& root = std::get<scenario::Table>(source.document->data);
    if (py::isinstance<PyMesh>(mesh)) {
        source.mesh = mesh.cast<std::shared_ptr<PyMesh>>()->data;
        const scenario::Array ones{
            {std::int64_t{1}, {}}, {std::int64_t{1}, {}}, {std::int64_t{1}, {}}};
        const scenario::Table box{{"size", {}, {ones, {}}}, {"cells", {}, {ones, {}}}};
        set_entry(root, "mesh", {scenario::Table{{"box", {}, {box, {}}}}, {}});
    } else if (py::isinstance<py::dict>(mesh)) {
        set_entry(root, "mesh", value_from(mesh, "mesh"));
    } else {
        set_entry(root, "mesh",
                  {scenario::Table{{"file", {}, {path_from(mesh).string(), {}}}}, {}});
    }
}

World make(Source source, int num_threads) {
    std::vector<std::string> warnings;
    World world;
    {
        const py::gil_scoped_release release;
        scenario::Scenario scenario =
            sound(source.document ? scenario::read_scenario(std::move(*source.document),
                                                            source.file, source.overrides)
                                  : scenario::read_scenario(source.file, source.overrides),
                  warnings);
        if (source.mesh) {
            scenario.mesh.source = std::move(source.mesh);
            scenario.mesh.location = source.file.string() + ": mesh";
        }
        try {
            world = std::make_shared<Handle>(std::move(scenario), source.is_endless);
        } catch (const scenario::BodyError&) {
            throw;
        } catch (const InputError& error) {
            throw InputError(
                joined(scenario::prefixed_lines(source.file.string() + ": ", error.what())));
        }
        world->driver.world().set_num_threads(num_threads);
    }
    world->num_threads = num_threads;
    for (const std::string& warning : warnings) pass_warning(warning);
    pass_warnings(world);
    return world;
}

World make_world(const py::object& scenario, const py::object& mesh, const py::object& materials,
                 const py::object& constraints, const py::object& loads, const py::object& tools,
                 const py::object& obstacles, const py::object& dynamics, const py::object& contact,
                 const py::object& output, const py::object& gravity, const py::object& damping,
                 const std::vector<std::string>& overrides, const py::object& folder,
                 int num_threads) {
    Source source;
    source.overrides = overrides;
    const std::pair<const char*, const py::object*> sections[] = {
        {"material", &materials}, {"constraint", &constraints}, {"load", &loads},
        {"tool", &tools},         {"obstacle", &obstacles},     {"dynamics", &dynamics},
        {"contact", &contact},    {"output", &output}};
    if (!scenario.is_none()) {
        bool has_sections = !mesh.is_none() || !gravity.is_none() || !damping.is_none();
        for (const auto& [key, value] : sections) has_sections |= !value->is_none();
        if (has_sections)
            throw InputError(
                "a world is made from a scenario or from sections such as mesh=... and "
                "materials=..., not from both; change single values by overrides=[...]");
    }
    const bool is_file = !scenario.is_none() && !py::isinstance<py::dict>(scenario);
    if (is_file) {
        if (!folder.is_none()) throw InputError("folder belongs to a scenario from dicts");
        source.file = path_from(scenario);
        return make(std::move(source), num_threads);
    }
    source.file = (folder.is_none() ? std::filesystem::path() : path_from(folder)) / "world";
    if (py::isinstance<py::dict>(scenario)) {
        py::dict rest(py::reinterpret_borrow<py::dict>(scenario).attr("copy")());
        const py::object given = rest.contains("mesh") ? py::object(rest["mesh"]) : py::none();
        if (py::isinstance<PyMesh>(given)) rest.attr("pop")("mesh");
        source.document = value_from(rest, "");
        if (py::isinstance<PyMesh>(given)) set_mesh(source, given);
    } else {
        source.document = scenario::Value{scenario::Table(), {}};
        if (!mesh.is_none()) set_mesh(source, mesh);
        auto& root = std::get<scenario::Table>(source.document->data);
        for (const auto& [key, value] : sections)
            if (!value->is_none()) set_entry(root, key, value_from(*value, key));
        for (const auto& [key, value] : {std::pair{"gravity", &gravity}, {"damping", &damping}}) {
            if (value->is_none()) continue;
            if (!find_entry(root, "dynamics")) set_entry(root, "dynamics", {scenario::Table(), {}});
            auto* table = std::get_if<scenario::Table>(&find_entry(root, "dynamics")->value.data);
            if (!table) continue;  // the reader refuses it
            if (find_entry(*table, key))
                throw InputError(std::string(key) + " is given twice: also in dynamics");
            set_entry(*table, key, value_from(*value, key));
        }
    }
    complete(source);
    return make(std::move(source), num_threads);
}

// --- Arrays

/// Returns values at the living nodes, in the rows of Python.
py::array_t<double> at_nodes(const World& world, std::span<const Vec3> values) {
    const Handle::Rows& rows = world->rows();
    if (rows.are_ids) return matrix_of(values);
    py::array_t<double> array({static_cast<py::ssize_t>(rows.nodes.size()), py::ssize_t{3}});
    double* out = array.mutable_data();
    for (const NodeId n : rows.nodes)
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
        for (const NodeId n : rows.nodes) *out++ = all[n.index()];
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
    for (const NodeId n : mesh.nodes()) *out++ = mesh.label(n);
    return array;
}

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

py::object cells(const World& world) {
    driver_of(world);
    return kept(world, world->cells, [&] {
        const Handle::Rows& rows = world->rows();
        const topology::Mesh& mesh = world->driver.world().mesh();
        CellArrays arrays(true);
        for (const ElementId e : mesh.elements())
            for (const NodeId n : mesh.corners(e)) arrays.of(mesh.kind(e)).push_back(rows.row(n));
        return arrays.object(true);
    });
}

py::object regions(const World& world) {
    driver_of(world);
    return kept(world, world->regions, [&] {
        const topology::Mesh& mesh = world->driver.world().mesh();
        CellArrays arrays(false);
        for (const ElementId e : mesh.elements()) arrays.of(mesh.kind(e)).push_back(mesh.region(e));
        return arrays.object(true);
    });
}

struct Surface {
    py::array_t<std::int64_t> vertices, triangles;
    py::array_t<bool> is_cut;
    std::uint64_t version;
};

py::object surface(const World& world) {
    driver_of(world);
    return kept(world, world->surface, [&] {
        const Handle::Rows& rows = world->rows();
        sim::World& body = world->driver.world();
        const topology::BoundarySurface& boundary = body.surface();
        const auto size = static_cast<py::ssize_t>(boundary.triangles().size());
        Surface made{{},
                     py::array_t<std::int64_t>({size, py::ssize_t{3}}),
                     py::array_t<bool>(size),
                     world->driver.topology_version()};
        std::vector<bool> is_on(body.mesh().num_nodes(), false);
        std::int64_t* out = made.triangles.mutable_data();
        for (const auto& triangle : boundary.triangles())
            for (const NodeId n : triangle) {
                *out = rows.row(n);
                is_on[static_cast<std::size_t>(*out++)] = true;
            }
        for (py::ssize_t t = 0; t < size; ++t)
            made.is_cut.mutable_at(t) = boundary.is_cut()[static_cast<std::size_t>(t)] != 0;
        std::vector<std::int64_t> vertices;
        for (std::size_t i = 0; i < is_on.size(); ++i)
            if (is_on[i]) vertices.push_back(static_cast<std::int64_t>(i));
        made.vertices =
            py::array_t<std::int64_t>(static_cast<py::ssize_t>(vertices.size()), vertices.data());
        frozen(made.vertices);
        frozen(made.triangles);
        frozen(made.is_cut);
        return py::cast(std::move(made));
    });
}

// --- Views

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
        owner.release();
        return frozen(py::array_t<double>({static_cast<py::ssize_t>(values.size()), py::ssize_t{3}},
                                          values.empty() ? nullptr : values.front().data(), base));
    }

  private:
    World world_;
    bool is_open_ = false;
};

// --- Steps

void poll() {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

template <class Steps>
Report carry_out(const World& world, Steps steps) {
    require_no_views(world);
    Report report = without_gil(world, steps);
    if (world->num_warned < world->driver.warnings().size()) pass_warnings(world);
    return report;
}

py::dict ledger(const World& world) {
    const WorldDriver& driver = driver_of(world);
    const double step = driver.world().num_steps() > 0 ? driver.last_step() : driver.next_step();
    py::dict dict;
    for (const auto& [name, value] :
         runner::summary_quantities(driver.world(), step, driver.edits()))
        dict[py::str(name)] = value;
    return dict;
}

void write_vtu(const World& world, const py::object& path) {
    const std::filesystem::path file = path_from(path);
    without_gil(world, [&](WorldDriver& driver) {
        const sim::World& body = driver.world();
        const auto forces = body.contact_forces();
        io::write_vtu(
            file,
            runner::build_frame(body.model(), body.time(), driver.scenario().output.fields,
                                forces ? &*forces : nullptr),
            driver.scenario().output.compression);
    });
}

py::dict tools(const World& world) {
    const sim::World& body = driver_of(world).world();
    py::dict dict;
    for (std::size_t i = 0; i < body.num_tools(); ++i) {
        const std::string& name = body.tool({i}).name;
        dict[py::str(name)] = Tool{world, {i}, name};
    }
    return dict;
}

Tool add_tool(const World& world, const std::string& name, const py::dict& definition,
              const std::optional<Pose>& pose) {
    const scenario::Value value = value_from(definition, "");
    WorldDriver& driver = driver_of(world);
    const sim::ToolId tool = driver.add_tool(name, value, pose);
    pass_warnings(world);
    return {world, tool, name};
}

Constraint grasp(const World& world, const std::string& name, const py::object& nodes,
                 const std::optional<Pose>& pose) {
    driver_of(world);
    std::vector<NodeId> held = nodes_of(*world, nodes);
    if (held.empty()) throw InputError("grasp '" + name + "': it has no node");
    // The conversion may have run code of the user, which can have used the world.
    WorldDriver& driver = driver_of(world);
    Pose frame;
    for (const NodeId n : held)
        frame.position += driver.world().positions()[n.index()] / static_cast<double>(held.size());
    driver.grasp(name, std::move(held), pose.value_or(frame));
    return {world, name};
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
        .def_property_readonly("version", held(&Surface::version),
                               "The topology_version that the arrays are for.");
}

void register_view(py::module_& module) {
    py::class_<View, std::shared_ptr<View>> type(
        module, "View",
        R"(Arrays that show the memory of a world: see World.view().

They are valid inside the with statement. An array that is kept longer still never dangles: it keeps
the world alive, and step(), run_until() and restore() raise BufferError until it is gone.)");
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

}  // namespace

void register_world(py::module_& module) {
    register_surface(module);
    register_view(module);
    py::class_<Handle, World> type(module, "World",
                                   R"(A soft body with its constraints, loads and tools.

Lengths are m, times s, masses kg, forces N. Rows of positions, velocities and masses are the nodes
of the body; cells, surface and grasp() name nodes by these rows. After an edit of the mesh, which
topology_version tells, rows are others: node_ids follow a node through edits.

Several threads may step several worlds. While one thread steps a world, it raises incise.Error in
others.

>>> world = incise.World(
...     mesh={"box": {"size": [0.1, 0.02, 0.02], "cells": [5, 1, 1]}},
...     materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}],
...     constraints=[{"name": "wall", "fix": "xyz",
...                   "where": {"box": {"min": [0, 0, 0], "max": [0, 1, 1]}}}],
...     gravity=[0, 0, -9.81], damping=5)
>>> report = world.run_until(0.05)
>>> bool(world.positions[:, 2].min() < 0)
True)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "save() its state");
    type.def(
            py::init(&make_world), py::arg("scenario") = py::none(), py::kw_only(),
            py::arg("mesh") = py::none(), py::arg("materials") = py::none(),
            py::arg("constraints") = py::none(), py::arg("loads") = py::none(),
            py::arg("tools") = py::none(), py::arg("obstacles") = py::none(),
            py::arg("dynamics") = py::none(), py::arg("contact") = py::none(),
            py::arg("output") = py::none(), py::arg("gravity") = py::none(),
            py::arg("damping") = py::none(), py::arg("overrides") = std::vector<std::string>(),
            py::arg("folder") = py::none(), py::arg("num_threads") = 1,
            R"(scenario: the name of a TOML file, or a dict with its keys; or the sections one by one:
mesh: a dict {"file": ...} or {"box": {...}}, the name of a file, or an incise.Mesh.
materials, constraints, loads, tools, obstacles: lists of dicts with the keys of [[material]],
    [[constraint]], [[load]], [[tool]] and [[obstacle]].
dynamics, contact, output: dicts with the keys of [dynamics], [contact] and [output].
gravity: three numbers, m/s2.  damping: 1/s.  Short for the keys of dynamics.
overrides: texts such as "dynamics.damping=3", as of `incise run --set`.
folder: to which names of files in dicts are relative. None: the current folder.
num_threads: threads of a step. They change no result.

Tools of a scenario follow their paths. A world from dicts needs no end_time.
Raises InputError with all faults of scenario and mesh. What is unusual becomes an InciseWarning.)")
        .def_property_readonly(
            "name", [](const World& world) { return driver_of(world).scenario().name; },
            "The name of the scenario: that of its file without folder and ending, or 'world'.")
        .def_property_readonly(
            "time", [](const World& world) { return driver_of(world).world().time(); },
            "The time of the world, s. 0 at first.")
        .def_property_readonly(
            "end_time",
            [](const World& world) -> std::optional<double> {
                const WorldDriver& driver = driver_of(world);
                if (driver.is_endless()) return std::nullopt;
                return driver.scenario().dynamics.end_time;
            },
            "The end time of the scenario, s. None if it says none. The world can run on.")
        .def_property_readonly(
            "output_interval",
            [](const World& world) { return driver_of(world).scenario().output.interval; },
            "The time between two frames of `incise run`, s; 0: no frames. run_until() of each\n"
            "multiple of it makes the steps of the program.")
        .def_property_readonly(
            "num_steps", [](const World& world) { return driver_of(world).world().num_steps(); },
            "Number of steps since the start.")
        .def_property_readonly(
            "stable_step",
            [](const World& world) { return driver_of(world).world().stable_step(); },
            "The upper bound on explicit steps in the present strain, s. Edits and strain change "
            "it.")
        .def_property_readonly(
            "topology_version",
            [](const World& world) { return driver_of(world).topology_version(); },
            "A number that changes with each edit of the mesh and with each restore().")
        .def_property_readonly(
            "has_failed", [](const World& world) { return driver_of(world).world().has_failed(); },
            "True after a step that failed: the world can be read and restored, but not stepped.")
        .def_property_readonly(
            "warnings", [](const World& world) { return driver_of(world).warnings(); },
            "The warnings about body and tools so far, a list of sentences. Each was also passed "
            "to\n"
            "Python's warnings as an InciseWarning.")
        .def_property(
            "num_threads",
            [](const World& world) {
                driver_of(world);
                return world->num_threads;
            },
            [](const World& world, int n) {
                driver_of(world).world().set_num_threads(n);
                world->num_threads = n;
            },
            "Number of threads of a step, 1 at first. It changes no result. Raises InputError "
            "below 1.")
        .def_property_readonly(
            "num_nodes",
            [](const World& world) { return driver_of(world).world().mesh().num_nodes(); },
            "Number of nodes: rows of positions.")
        .def_property_readonly(
            "num_cells",
            [](const World& world) { return driver_of(world).world().mesh().num_elements(); },
            "Number of elements of all kinds.")
        .def_property_readonly(
            "positions",
            [](const World& world) {
                return at_nodes(world, driver_of(world).world().positions());
            },
            "The positions of the nodes, m. float64, shape (N, 3), a copy.")
        .def_property_readonly(
            "velocities",
            [](const World& world) {
                return at_nodes(world, driver_of(world).world().velocities());
            },
            "The velocities of the nodes, m/s. float64, shape (N, 3), a copy.")
        .def_property_readonly(
            "rest_positions",
            [](const World& world) {
                return at_nodes(world, driver_of(world).world().mesh().rest_positions());
            },
            "The positions of the nodes at rest, m. float64, shape (N, 3), a copy.")
        .def_property_readonly("masses", &masses,
                               "The mass at each node, kg. float64, shape (N,), a copy.")
        .def_property_readonly(
            "contact_forces", &contact_forces,
            "The force of contact on each node in the last step, N. float64, shape (N, 3), a copy.")
        .def_property_readonly(
            "node_ids", &node_ids,
            "The number of each node that stays with it through edits, as the array node_id of a\n"
            "frame: its number in the mesh file, or a new one. int64, shape (N,), a copy.")
        .def_property_readonly(
            "cells", &cells,
            "The elements as rows of positions, in the order of VTK: int64, shape (M, 4) or (M, "
            "8),\n"
            "a read-only copy. Of a mixed mesh a dict of such arrays by kind: tetrahedron,\n"
            "hexahedron, wedge, pyramid. The same object until the topology_version changes.")
        .def_property_readonly(
            "regions", &regions,
            "The region of each element, int64, shape (M,), read-only; a dict if cells is one.")
        .def_property_readonly("surface", &surface,
                               "The surface of the body, a Surface. The same object until the "
                               "topology_version changes.")
        .def(
            "view",
            [](const World& world) {
                driver_of(world);
                return std::make_shared<View>(world);
            },
            R"(Return a View: arrays without a copy, read-only, in a with statement.

step(), run_until() and restore() raise BufferError while it is open or one of its arrays is kept.
After nodes have been removed, the arrays are copies.

>>> world = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> with world.view() as view:
...     top = view.positions[:, 2].max()
>>> float(top)
1.0)")
        .def(
            "step",
            [](const World& world, std::optional<double> dt, std::int64_t n) {
                if (n < 1)
                    throw InputError("a call of " + std::to_string(n) +
                                     " steps: n must be at least 1");
                return carry_out(world, [&](WorldDriver& driver) {
                    return driver.step(dt, static_cast<std::uint64_t>(n), poll);
                });
            },
            py::arg("dt") = py::none(), py::arg("n") = 1,
            R"(Make n steps and return a StepReport. Other Python threads run meanwhile.

dt: length of a step, s, at most the stable step of the body at rest. None: the fixed step of the
    scenario if it has one, else the stable step times the safety of the scenario, 0.8.
n: number of steps. Tools go evenly to their poses during the whole call.

Raises InputError for a step that cannot be, PhysicsError if the motion is lost, BufferError while a
view is open, incise.Error while another thread uses the world, KeyboardInterrupt between steps.)")
        .def(
            "run_until",
            [](const World& world, double time) {
                return carry_out(world,
                                 [&](WorldDriver& driver) { return driver.run_until(time, poll); });
            },
            py::arg("time"),
            R"(Step to a time, s, evenly as `incise run` does between frames. Return a StepReport.

Tools go evenly to their poses during the whole call. Raises what step() raises, and InputError for
a time that has passed. At the present time nothing happens.)")
        .def("add_tool", &add_tool, py::arg("name"), py::arg("definition"),
             py::arg("pose") = py::none(), R"(Add a tool that you lead, and return it as a Tool.

name: letters, digits, _ and -; no other tool of the world has it. A tool cannot be removed; one
    that was withdrawn costs nothing.
definition: a dict with the keys of [[tool]] without times and path: kind and, for a
    blade: edge, mode, snap, toughness, cutting_force;  carver: shape;  probe: shape, friction;
    grasper: shape, max_force;  suture: points, stiffness, max_force, reach;
    cut: plane or surface, snap. A cut divides the body in the next step.
pose: a Pose where the tool is now. None: the tool is there from the first pose that you set.
Raises InputError with all faults of the definition.

>>> world = incise.World(mesh={"box": {"size": [0.1, 0.1, 0.1], "cells": [2, 2, 2]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> knife = world.add_tool("knife", {"kind": "blade", "edge": [[0, -1, 0], [0, 1, 0]]},
...                        incise.Pose([0.03, 0, 0.2]))
>>> knife.pose = incise.Pose([0.03, 0, -0.1])
>>> len(world.run_until(0.01).edits) > 0
True)")
        .def_property_readonly("tools", &tools,
                               "All tools by name: a dict of Tool, those of the scenario first.")
        .def("grasp", &grasp, py::arg("name"), py::arg("nodes"), py::arg("pose") = py::none(),
             R"(Hold nodes where they are now, and return the grasp as a Constraint.

nodes: rows of positions.  pose: the frame that they go with; None: at their centre.
Set the pose of the grasp to move them, and release() it. Nodes that cuts make between held nodes
are held too. Raises InputError if another constraint holds a node otherwise.)")
        .def_property_readonly(
            "constraints",
            [](const World& world) {
                py::dict dict;
                for (const NamedConstraint& constraint : driver_of(world).constraints())
                    dict[py::str(constraint.name)] = Constraint{world, constraint.name};
                return dict;
            },
            "All constraints by name: a dict of Constraint, with their reaction forces.")
        .def_property_readonly(
            "loads",
            [](const World& world) {
                py::dict dict;
                for (const physics::Load& load : driver_of(world).world().model().loads().all())
                    dict[py::str(load.name)] = Load{world, load.name};
                return dict;
            },
            "All loads by name: a dict of Load.")
        .def(
            "edits", [](const World& world) { return edits_of(driver_of(world).edits()); },
            "Return the record of all edits of the mesh so far, a list of dicts with the names of\n"
            "edits.jsonl: time, s; step; tool; elements_removed, elements_split, elements_added,\n"
            "faces_opened, cut_area, m2; mass_removed, kg; before and after, dicts of totals; ...")
        .def("ledger", &ledger,
             "Return masses, energies, momenta and forces, a dict with the names of history.csv "
             "and\n"
             "of summary.json: mass, kg; kinetic_energy, J; reaction_wall_z, N; mass_error; ...")
        .def(
            "save",
            [](const World& world) {
                const std::string bytes =
                    without_gil(world, [](WorldDriver& driver) { return driver.save(); });
                return py::bytes(bytes);
            },
            "Return the state as bytes: mesh, motion, constraints, loads, tools, cuts in "
            "progress,\n"
            "and the poses that were set. Some 100 bytes an element and as many a node.")
        .def(
            "restore",
            [](const World& world, const py::bytes& data) {
                require_no_views(world);
                const std::string_view bytes = data;
                without_gil(world, [&](WorldDriver& driver) { driver.restore(bytes); });
            },
            py::arg("data"),
            R"(Go back to a state that save() has returned, in this world or another one.

Later steps then give the same bits. The other world needs the same materials, solver and scenario
tools; its mesh may be another. Raises InputError, and changes nothing, for other bytes.)")
        .def("write_vtu", &write_vtu, py::arg("path"),
             "Write the present state to a file for ParaView, as a frame of `incise run`.\n"
             "path: ends in .vtu. Raises OutputError if it cannot be written.")
        .def(
            "__repr__",
            [](const World& world) {
                const WorldDriver& driver = driver_of(world);
                std::ostringstream text;
                text << "<incise.World '" << driver.scenario().name
                     << "': " << driver.world().mesh().num_elements()
                     << " elements, t = " << driver.world().time() << " s>";
                return text.str();
            },
            "Return name, size and time as text.");
}

}  // namespace incise::python
