// incise.World.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <optional>
#include <sstream>
#include <utility>

#include "incise/base/error.h"
#include "incise/io/vtk/vtu_writer.h"
#include "incise/python/handle.h"
#include "incise/python/records.h"
#include "incise/python/values.h"
#include "incise/python/world_arrays.h"
#include "incise/python/world_source.h"
#include "incise/runner/frame_builder.h"
#include "incise/runner/measured_quantities.h"

namespace incise::python {

namespace {

void poll() {
    const py::gil_scoped_acquire acquire;
    Unlocked::stop_at_end();
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
         runner::summary_quantities(driver.world(), step, driver.tool_forces(), driver.edits()))
        dict[py::str(name)] = value;
    return dict;
}

void write_vtu(const World& world, const py::object& path) {
    const std::filesystem::path file = file_from(path, "path", "file that ends in .vtu");
    if (file.extension() != ".vtu")
        throw InputError(file.string() +
                         ": must end in .vtu; for meshes of other formats see "
                         "incise.Mesh.write()");
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

void register_undo_point(py::module_& module) {
    py::class_<UndoPoint, std::shared_ptr<UndoPoint>> type(
        module, "UndoPoint", "A moment of a World, to which World.undo() can go back.");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep it as it is");
    type.def("__repr__", held(+[](const UndoPoint& point) {
                 std::ostringstream text;
                 text << "<incise.UndoPoint at t = " << point.time << " s>";
                 return text.str();
             }));
}
}  // namespace

void register_world(py::module_& module) {
    register_undo_point(module);
    register_elements(module);
    register_physics(module);
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
            py::arg("damping") = py::none(), py::arg("overrides") = py::tuple(),
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
                if (driver.scenario().dynamics.is_endless) return std::nullopt;
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
            "A number that changes with each edit of the mesh, and with each restore() and undo().")
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
        .def_property_readonly(
            "masses", &masses,
            "The mass of the material at each node, kg. float64, shape (N,), a copy. For momentum\n"
            "and energy see physics.")
        .def_property_readonly(
            "contact_forces", &contact_forces,
            "The force of contact on each node in the last step, N. float64, shape (N, 3), a copy.")
        .def_property_readonly(
            "node_ids", &node_ids,
            "The number of each node that stays with it through edits, as the array node_id of a\n"
            "frame: its number in the mesh file, or a new one. int64, shape (N,), a copy.")
        .def_property_readonly(
            "cells", &cells,
            "The elements as rows of positions, in the order of VTK: int64, shape (M, 4) to (M, "
            "8),\n"
            "a read-only copy. Of several kinds a dict of such arrays by kind: tetrahedron,\n"
            "hexahedron, wedge, pyramid. Cuts leave polyhedra, in bodies of tetrahedra too. They\n"
            "are in one list under the key polyhedron: for each the number of its faces, then for\n"
            "each face the number of its nodes and its nodes. The same object until the\n"
            "topology_version changes. For what does not depend on kinds see elements.")
        .def_property_readonly(
            "regions", &regions,
            "The region of each element, int64, shape (M,), read-only; a dict if cells is one.")
        .def_property_readonly(
            "elements", &elements,
            R"(Volumes, centres, regions and components of the elements of all kinds, an Elements.

The same object until the topology_version changes.

>>> world = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> float(round(world.elements.volumes.sum(), 9)), world.elements.centres.shape
(1.0, (6, 3)))")
        .def_property_readonly(
            "components", &components,
            "The connected component that each node belongs to: elements hang together through\n"
            "faces. Numbers from 0 on, each of them there: int64, shape (N,), read-only. The same\n"
            "object until the topology_version changes.")
        .def_property_readonly(
            "stress", &stress,
            "The Cauchy stress in each element, Pa: float64, shape (M, 3, 3), a copy; a dict if\n"
            "cells is one. Parts of a cut element have the stress of their fragment. Springs have\n"
            "a mean. It is that of the elastic forces, without damping.")
        .def_property_readonly(
            "volume_ratio", &volume_ratio,
            "The volume of each element over its volume at rest: float64, shape (M,), a copy; a\n"
            "dict if cells is one. It is that of the fragment that carries the element.")
        .def_property_readonly("surface", &surface,
                               "The surface of the body, a Surface. The same object until the "
                               "topology_version changes.")
        .def_property_readonly("physics", &physics,
                               R"(The nodes that carry the momentum of the body, a Physics, anew.

The sums of masses * velocities and of masses * velocities**2 / 2 over them are the momentum and the
kinetic energy of ledger(). World.masses and World.velocities are at the nodes of the mesh that is
cut: after a cut these follow the nodes here, and their sums are others by a few per cent.

>>> world = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> float(round(world.physics.masses.sum(), 6))
1000.0)")
        .def("view", &view,
             R"(Return a View: arrays without a copy, read-only, in a with statement.

step(), run_until(), restore(), undo() and set_material() raise BufferError while it is open or one
of its arrays is kept. After nodes have been removed, the arrays are copies.

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
                world->last_point.reset();  // it is of the body before
            },
            py::arg("data"),
            R"(Go to a state that save() has returned, in this world or another one.

Later steps then give the same bits. The other world needs the same materials, solver and scenario
tools; its mesh may be another. Raises InputError, and changes nothing, for other bytes.)")
        .def(
            "undo_point",
            [](const World& world) {
                world->last_point = without_gil(world, [](WorldDriver& driver) {
                    return std::make_shared<UndoPoint>(driver.undo_point());
                });
                return world->last_point;
            },
            R"(Return the present moment, an UndoPoint, to which undo() can go back.

The world keeps the last one, for undo() without a point. It costs a few steps at most, and less
than save(). From now on the world keeps its edits, until all points from before them are gone.)")
        .def(
            "undo",
            [](const World& world, const std::shared_ptr<UndoPoint>& point) {
                require_no_views(world);
                const std::shared_ptr<UndoPoint> to = point ? point : world->last_point;
                if (!to)
                    throw InputError(
                        "the world has no moment to go back to: call undo_point() before the cut");
                without_gil(world, [&](WorldDriver& driver) { driver.undo(*to); });
                world->last_point = to;
            },
            py::arg("point") = py::none(),
            R"(Go back to a moment of this world: take back all cuts since then, and give body, tools,
constraints, loads and time what they had.

point: from undo_point(); None: the last one that was taken or gone back to. save() then returns the
bytes of that moment, and later steps give the same bits. It costs some steps, and for each element
that was cut since then about 0.0125 ms: little after a short stroke. It also brings a world back
that has failed. The same point can be used again.

Raises InputError, and changes nothing, for a point of another world, for one after an edit that was
taken back, and for one from before restore().

>>> world = incise.World(
...     mesh={"box": {"size": [0.1, 0.02, 0.02], "cells": [5, 1, 1]}},
...     materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> before = world.undo_point()
>>> knife = world.add_tool("knife", {"kind": "carver", "shape": {"sphere": {"radius": 0.01}}})
>>> knife.place(incise.Pose([0.1, 0.01, 0.01]))
>>> _ = world.step()
>>> len(world.edits())
1
>>> world.undo(before)
>>> world.edits(), world.tools
([], {})
)")
        .def(
            "render",
            [](const py::object& world, int width, int height, const py::object& view,
               const py::object& channels) {
                return py::module_::import("incise._picture")
                    .attr("render")(world, width, height, view, channels);
            },
            py::arg("width") = 640, py::arg("height") = 480,
            py::arg("view") = py::make_tuple(-0.5, -1.0, 0.5), py::arg("channels") = "rgb",
            R"(Return a picture of the body and of the tools that are there, without a display.

width, height: pixels.
view: the direction from the body to the camera, three numbers: the whole body is in the picture,
    with z upwards. Or a dict with "position" and, if wanted, "target", m, and "field_of_view",
    vertical, rad.
channels: a name, or several of them; one gives an array, several a dict of arrays by name:
    "rgb": uint8, shape (height, width, 3); faces of cuts are red.
    "depth": distance from the camera along its axis, m, float64, (height, width); inf where there
        is nothing.
    "segmentation": int64, (height, width): the region of the tissue; -1 where there is nothing;
        -2 for the first of World.tools, -3 for the second, ...

Half spaces, sutures and cuts at once are not drawn. Raises ValueError for what cannot be, such as
labels of a body with regions below 0.

>>> world = incise.World(mesh={"box": {"size": [1, 1, 1], "cells": [1, 1, 1]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> picture = world.render(320, 240, channels=("rgb", "segmentation"))
>>> picture["rgb"].shape, picture["segmentation"].min(), picture["segmentation"].max()
((240, 320, 3), -1, 0)
)")
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
    register_world_parts(type);
}

}  // namespace incise::python
