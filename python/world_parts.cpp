// incise.World: what a program adds to a world and changes in it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <optional>
#include <utility>

#include "incise/base/error.h"
#include "incise/python/handle.h"
#include "incise/python/tools.h"
#include "incise/python/values.h"

namespace incise::python {

namespace {

py::dict tools(const World& world) {
    const sim::World& body = driver_of(world).world();
    py::dict dict;
    for (const sim::ToolId id : body.tools()) {
        const std::string& name = body.tool(id).name;
        dict[py::str(name)] = Tool{world, id, name};
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
    std::vector<VertexId> held = nodes_of(*world, nodes);
    if (held.empty()) throw InputError("grasp '" + name + "': it has no node");
    // The conversion may have run code of the user, which can have used the world.
    WorldDriver& driver = driver_of(world);
    Pose frame;
    for (const VertexId n : held)
        frame.position += driver.world().positions()[n.index()] / static_cast<double>(held.size());
    driver.grasp(name, std::move(held), pose.value_or(frame));
    return {world, name};
}

Constraint add_constraint(const World& world, const std::string& name, const py::dict& definition) {
    const scenario::Value value = value_from(definition, "");
    driver_of(world).add_constraint(name, value);
    pass_warnings(world);
    return {world, name};
}

Load add_load(const World& world, const std::string& name, const py::dict& definition) {
    const scenario::Value value = value_from(definition, "");
    driver_of(world).add_load(name, value);
    pass_warnings(world);
    return {world, name};
}

void set_material(const World& world, const py::dict& definition) {
    require_no_views(world);
    const scenario::Value value = value_from(definition, "");
    without_gil(world, [&](WorldDriver& driver) { driver.set_material(value); });
    pass_warnings(world);
}

}  // namespace

void register_world_parts(py::class_<Handle, World>& type) {
    type.def("add_tool", &add_tool, py::arg("name"), py::arg("definition"),
             py::arg("pose") = py::none(), R"(Add a tool that you lead, and return it as a Tool.

name: letters, digits, _ and -; no other tool of the world has it. A tool cannot be removed; one
    that was withdrawn costs nothing.
definition: a dict with the keys of [[tool]] without times and path: kind, and the keys of the kind.
    docs/tools.md and docs/contact.md have them all; a wrong one is refused, with those that there
    are. A tool with kind "cut" divides the body in the next step.
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
        .def("add_constraint", &add_constraint, py::arg("name"), py::arg("definition"),
             R"(Add a constraint to the world from the next step on, and return it as a Constraint.

name: letters, digits, _ and -; no other constraint of the world has it.
definition: a dict with the keys of [[constraint]] but name: where, fix, move, rotate, about. Nodes
    are chosen where they rest, and move from there; times are those of the world. The key `nodes`
    of `where` has numbers of the mesh, not rows: of rows it is node_ids[rows]. For nodes that
    are elsewhere than it says an InciseWarning tells how far they jump: use grasp() to hold nodes
    where they are.
Raises InputError with all faults of the definition, and if another constraint prescribes another
motion of a node. Constraint.change() and release() change and remove it.

>>> world = incise.World(mesh={"box": {"size": [0.1, 0.02, 0.02], "cells": [5, 1, 1]}},
...                      materials=[{"density": 1000, "young": 1e5, "poisson": 0.4}])
>>> wall = world.add_constraint("wall", {"fix": "xyz", "where": {
...     "box": {"min": [0, 0, 0], "max": [0, 1, 1]}}})
>>> world.set_gravity([0, 0, -9.81])
>>> _ = world.run_until(0.01)
>>> bool(wall.force[2] > 0)
True)")
        .def("add_load", &add_load, py::arg("name"), py::arg("definition"),
             R"(Add a load to the world from the next step on, and return it as a Load.

name: letters, digits, _ and -; no other load of the world has it.
definition: a dict with the keys of [[load]] but name: where; one of nodal_force, traction, pressure
    and body_force; factor, with times of the world.
Raises InputError with all faults of the definition. Load.factor, change() and remove() go on from
there.)")
        .def("set_material", &set_material, py::arg("definition"),
             R"(Give regions another material from the next step on, such as tissue that is heated.

definition: a dict with the keys of [[material]] but fibre_array. `regions` says which; without it
    all have the new material. The density must stay what it is.
The body keeps its shape, its motion and its masses. The jump of its elastic energy counts as
external work. Viscous stress stays if the series of `prony` has as many terms as before.
undo() brings the former materials back; restore() needs bytes of a world whose materials were
changed likewise.
Raises InputError, and changes nothing, for what is wrong with the definition or does not suit the
elements, and BufferError while a view is open.)")
        .def(
            "set_gravity",
            [](const World& world, const py::object& gravity) {
                const Vec3 vector = vector_from(gravity, "gravity");
                driver_of(world).world().set_gravity(vector);
            },
            py::arg("gravity"), "Set the gravity from the next step on: three numbers, m/s2.")
        .def(
            "set_damping",
            [](const World& world, double damping) {
                driver_of(world).world().set_damping(damping);
            },
            py::arg("damping"),
            "Set the mass-proportional damping from the next step on, 1/s, 0 or more.")
        .def_property_readonly(
            "gravity",
            [](const World& world) {
                return array_of(driver_of(world).world().model().boundary().loads().gravity());
            },
            "The gravity, m/s2. Shape (3,), a copy. See set_gravity().")
        .def_property_readonly(
            "damping",
            [](const World& world) {
                return driver_of(world).world().model().boundary().damping();
            },
            "The mass-proportional damping, 1/s. See set_damping().")
        .def_property_readonly(
            "constraints",
            [](const World& world) {
                py::dict dict;
                const physics::Model& model = driver_of(world).world().model();
                for (std::size_t i = 0; i < model.boundary().constraints().size(); ++i)
                    dict[py::str(model.boundary().constraints().name(i))] =
                        Constraint{world, model.boundary().constraints().name(i)};
                return dict;
            },
            "All constraints by name: a dict of Constraint, with their reaction forces.")
        .def_property_readonly(
            "loads",
            [](const World& world) {
                py::dict dict;
                for (const physics::Load& load :
                     driver_of(world).world().model().boundary().loads().all())
                    dict[py::str(load.name)] = Load{world, load.name};
                return dict;
            },
            "All loads by name: a dict of Load.");
}

}  // namespace incise::python
