// incise.Tool, incise.Constraint and incise.Load.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/python/tools.h"

#include <algorithm>
#include <utility>

#include "incise/base/error.h"
#include "incise/contact/tool_contact.h"
#include "incise/python/values.h"
#include "incise/scenario/tools/tool_kind.h"

namespace incise::python {

namespace {

/// Returns the driver of the world of a tool. Throws InputError if the world was restored to a
/// state without the tool.
WorldDriver& driver_of(const Tool& tool) {
    WorldDriver& driver = python::driver_of(tool.world);
    const bool is_there = [&] {
        try {
            return driver.world().tool(tool.id).name == tool.name;
        } catch (const InputError&) {
            return false;
        }
    }();
    if (!is_there)
        throw InputError("tool '" + tool.name +
                         "' is no longer in its world, which was restored to a state without it");
    return driver;
}

/// Returns the driver of the world of a constraint. Throws InputError if it was released.
WorldDriver& driver_of(const Constraint& constraint) {
    WorldDriver& driver = python::driver_of(constraint.world);
    try {
        driver.constraint(constraint.name);
    } catch (const InputError&) {
        throw InputError("constraint '" + constraint.name + "' is no longer in its world");
    }
    return driver;
}

const physics::Reaction& reaction_of(const Constraint& constraint) {
    const WorldDriver& driver = driver_of(constraint);
    return driver.world().reaction(driver.constraint(constraint.name));
}

/// The points at which tissue exerts forces on a tool, as arrays.
struct ToolContacts {
    py::array_t<double> points, normals, depths, normal_forces, friction_forces;
    py::array_t<std::int64_t> regions;
};

ToolContacts contacts_of(const Tool& tool) {
    const auto points = driver_of(tool).world().tool_contacts(tool.id);
    const auto vectors = [&](Vec3 contact::ToolContactPoint::*member) {
        std::vector<Vec3> values;
        for (const contact::ToolContactPoint& point : points) values.push_back(point.*member);
        return matrix_of(values);
    };
    const auto n = static_cast<py::ssize_t>(points.size());
    ToolContacts contacts{vectors(&contact::ToolContactPoint::point),
                          vectors(&contact::ToolContactPoint::normal),
                          py::array_t<double>(n),
                          vectors(&contact::ToolContactPoint::normal_force),
                          vectors(&contact::ToolContactPoint::friction_force),
                          py::array_t<std::int64_t>(n)};
    std::ranges::transform(points, contacts.depths.mutable_data(),
                           &contact::ToolContactPoint::depth);
    std::ranges::transform(points, contacts.regions.mutable_data(),
                           &contact::ToolContactPoint::region);
    return contacts;
}

void register_tool_contacts(py::module_& module) {
    py::class_<ToolContacts, std::shared_ptr<ToolContacts>> type(
        module, "ToolContacts",
        R"(The points at which tissue exerts forces on a tool: see Tool.contacts.

All arrays have a row for each of the N points, and are copies. Lengths are m, forces N, in the
frame of the world.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its arrays");
    type.def_property_readonly("points", held(&ToolContacts::points),
                               "The points on the tool, shape (N, 3).")
        .def_property_readonly("normals", held(&ToolContacts::normals),
                               "From the tissue to the tool, of length one, shape (N, 3). Zero in "
                               "jaws.")
        .def_property_readonly("depths", held(&ToolContacts::depths),
                               "By how much tool and tissue overlap there, shape (N,). Below 0: "
                               "they met in the\nlast substep. 0 in jaws.")
        .def_property_readonly("normal_forces", held(&ToolContacts::normal_forces),
                               "The forces on the tool along the normals, shape (N, 3).")
        .def_property_readonly("friction_forces", held(&ToolContacts::friction_forces),
                               "The other forces on the tool, shape (N, 3). In jaws these are all.")
        .def_property_readonly("regions", held(&ToolContacts::regions),
                               "The region of the tissue, int64, shape (N,).")
        .def("__len__", held(+[](const ToolContacts& contacts) {
                 return static_cast<std::size_t>(contacts.regions.size());
             }),
             "Return the number of points.")
        .def("__repr__", held(+[](const ToolContacts& contacts) {
                 return "<incise.ToolContacts: " + std::to_string(contacts.regions.size()) +
                        " points>";
             }),
             "Return the number of points as text.");
}

void register_tool(py::module_& module) {
    py::class_<Tool, std::shared_ptr<Tool>> type(
        module, "Tool",
        R"(A tool of a world: see World.add_tool() and World.tools.

A tool of a scenario follows its path there; it can be looked at, but not led. All methods raise
InputError for a tool of the wrong kind, and incise.Error while another thread uses the world.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its name");
    type.def_property_readonly("name", held(&Tool::name), "The name of the tool.")
        .def_property_readonly("kind", held(+[](const Tool& tool) {
                                   const auto& def = driver_of(tool).world().tool(tool.id);
                                   return cutting::traits_of(def.shape).kind;
                               }),
                               "The key `kind` of its definition, such as 'blade'.")
        .def_property_readonly("is_scripted", held(+[](const Tool& tool) {
                                   return driver_of(tool).is_scripted(tool.id);
                               }),
                               "True if the scenario leads the tool along a path.")
        .def_property_readonly(
            "is_present", held(+[](const Tool& tool) {
                return driver_of(tool).world().is_tool_present(tool.id);
            }),
            "True while the tool acts: from its first pose until it has been withdrawn.")
        .def_property(
            "pose", held(+[](const Tool& tool) { return driver_of(tool).tool_pose(tool.id); }),
            held(+[](const Tool& tool, const py::object& pose) {
                driver_of(tool).set_tool_target(tool.id, given_pose(pose));
            }),
            R"(Where the tool is to be at the end of the next call of step() or run_until(), a Pose.

During the call the tool goes there straight and by the shortest turn, and acts on all that it
meets. A tool that is not there appears at the pose. Before a pose is set it is where the tool is;
None for a tool that is not there. A call that is refused keeps the pose that was set: set another.)")
        .def_property_readonly("current_pose", held(+[](const Tool& tool) -> std::optional<Pose> {
                                   const sim::World& world = driver_of(tool).world();
                                   if (!world.is_tool_present(tool.id)) return std::nullopt;
                                   return world.tool_pose(tool.id);
                               }),
                               "Where the tool is now, a Pose. None for a tool that is not there.")
        .def("place", held(+[](const Tool& tool, const Pose& pose) {
                 driver_of(tool).place_tool(tool.id, pose);
             }),
             py::arg("pose"), R"(Put the tool at a pose at once. It meets nothing on its way there.

Raises InputError for a blade whose cut ends in the tissue: withdraw it first.)")
        .def_property_readonly(
            "force", held(+[](const Tool& tool) {
                return array_of(driver_of(tool).tool_forces().of(tool.id).force);
            }),
            R"(What the tissue exerted on the tool in the last call, N. Shape (3,), a copy.

In the frame of the world, mean over the last call of step() or run_until(), as the tool_forces of
its StepReport. Zero for carvers, cuts, and blades without a
toughness. For a suture it is the force on its thread at its first point; its length is the tension.)")
        .def_property_readonly(
            "torque", held(+[](const Tool& tool) {
                return array_of(driver_of(tool).tool_forces().of(tool.id).torque);
            }),
            "The same for the torque about the origin of the tool, N m. Shape (3,), a copy.")
        .def_property_readonly("contacts",
                               held(+[](const Tool& tool) { return contacts_of(tool); }),
                               R"(Where tissue touches a probe or a grasper, a ToolContacts, anew.

It has the points with a force in the last step; of several substeps, those in the last one. In a
step of one substep their forces add up to the force of a call of that step. Other tools have none,
and none has any after restore() or undo().)")
        .def_property_readonly(
            "definition", held(+[](const Tool& tool) -> py::object {
                const auto& shape = driver_of(tool).world().tool(tool.id).shape;
                const auto definition = scenario::definition_of(shape);
                return definition ? object_from(*definition) : py::none();
            }),
            R"(How the tool looks: a new dict with the keys kind, and edge or shape, of [[tool]].

A shape from a file comes as {"mesh": {"points", "triangles"}}, a half space as {"plane": {"point",
"normal"}}. None for tools that have no body: cuts at once, and sutures.)")
        .def_property_readonly(
            "is_in_tissue",
            held(+[](const Tool& tool) { return driver_of(tool).is_in_tissue(tool.id); }),
            "True if the tool divides elements and its cut ended in one in the last step.")
        .def("withdraw", held(+[](const Tool& tool) { driver_of(tool).withdraw_tool(tool.id); }),
             R"(Take the tool away at the end of the next call of step() or run_until().

It still acts in that call, with a pose that is set before or after this. Its cut ends where the
blade then is. A new pose after that brings it back, for another cut.)")
        .def("close", held(+[](const Tool& tool) { return driver_of(tool).close(tool.id); }),
             R"(Close the jaws of a grasper, or begin to close scissors.

Jaws hold the surface that is in them from now on. Returns how many points they hold: 0 if there is
no tissue in them. Scissors close while the world steps, in their closing_time; they hold nothing.)")
        .def("open", held(+[](const Tool& tool) { driver_of(tool).open(tool.id); }),
             "Open the jaws of a grasper, or begin to open scissors. Tissue keeps its velocity.")
        .def_property_readonly(
            "held",
            held(+[](const Tool& tool) { return driver_of(tool).world().num_held(tool.id); }),
            "How many points a grasper holds. 0 if it is open, or if all have slipped out.")
        .def("tie", held(+[](const Tool& tool) { return driver_of(tool).tie(tool.id); }),
             R"(Pass the thread of a suture through its points, where the tissue now is.

The thread is then as long as its way. Returns through how many points it passes: points without
tissue in reach are left out.)")
        .def("tighten", held(+[](const Tool& tool, double length) {
                 driver_of(tool).set_suture_target(tool.id, length);
             }),
             py::arg("length"),
             R"(Draw the thread of a tied suture to a length without tension, m, 0 or more.

It has this length at the end of the next call of step() or run_until(), and gets there evenly.)")
        .def("untie", held(+[](const Tool& tool) { driver_of(tool).untie(tool.id); }),
             "Take the thread of a suture out of the tissue.")
        .def_property_readonly(
            "is_tied",
            held(+[](const Tool& tool) { return driver_of(tool).world().is_suture_tied(tool.id); }),
            "True from tie() to untie(), until the thread of the suture has torn.")
        .def_property_readonly(
            "length",
            held(+[](const Tool& tool) { return driver_of(tool).world().suture_length(tool.id); }),
            "The length of the thread of a suture without tension, m. 0 if it is not tied.")
        .def("__repr__",
             held(+[](const Tool& tool) { return "<incise.Tool '" + tool.name + "'>"; }),
             "Return the name as text.");
}

void register_constraint(py::module_& module) {
    py::class_<Constraint, std::shared_ptr<Constraint>> type(
        module, "Constraint",
        R"(A constraint of a world: see World.constraints and World.grasp().

Those of a scenario hold or move nodes as it says. A grasp carries nodes with a frame.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its name");
    type.def_property_readonly("name", held(&Constraint::name), "The name of the constraint.")
        .def_property_readonly(
            "force", held(+[](const Constraint& constraint) {
                return array_of(reaction_of(constraint).force);
            }),
            R"(The force that the constraint exerted on the body, mean over the last step, N. Shape (3,).

That of a tool is a mean over the last call.

A grasp on moving tissue stops it within one step: leave out that step, or take a mean.)")
        .def_property_readonly(
            "torque", held(+[](const Constraint& constraint) {
                return array_of(reaction_of(constraint).torque);
            }),
            "The torque that it exerted about the origin of the world, N m. Shape (3,), a copy.")
        .def_property_readonly(
            "is_grasp", held(+[](const Constraint& constraint) {
                return driver_of(constraint).grasp_pose(constraint.name).has_value();
            }),
            "True for the result of World.grasp().")
        .def_property(
            "pose", held(+[](const Constraint& constraint) {
                return driver_of(constraint).grasp_pose(constraint.name);
            }),
            held(+[](const Constraint& constraint, const py::object& pose) {
                driver_of(constraint).set_grasp_target(constraint.name, given_pose(pose));
            }),
            R"(Where the frame of a grasp is to be at the end of the next call of step() or run_until().

The nodes go with the frame. None for a constraint that is no grasp; setting it then raises
InputError.)")
        .def("change", held(+[](const Constraint& constraint, const py::dict& definition) {
                 const scenario::Value value = value_from(definition, "");
                 driver_of(constraint).set_constraint(constraint.name, value);
                 pass_warnings(constraint.world);
             }),
             py::arg("definition"),
             R"(Put another constraint in the place of this one, from the next step on.

definition: as of World.add_constraint(). Raises InputError for a grasp, and as that does.)")
        .def("release", held(+[](const Constraint& constraint) {
                 driver_of(constraint).release(constraint.name);
             }),
             "Remove the constraint. Its nodes keep their velocities.")
        .def("__repr__", held(+[](const Constraint& constraint) {
                 return "<incise.Constraint '" + constraint.name + "'>";
             }),
             "Return the name as text.");
}

void register_load(py::module_& module) {
    py::class_<Load, std::shared_ptr<Load>> type(module, "Load",
                                                 "A load: see World.loads and World.add_load().");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its name");
    type.def_property_readonly("name", held(&Load::name), "The name of the load.")
        .def_property(
            "factor",
            held(+[](const Load& load) { return driver_of(load.world).load_factor(load.name); }),
            held(+[](const Load& load, double factor) {
                driver_of(load.world).set_load_factor(load.name, factor);
            }),
            "By what the load is multiplied, now. Setting it replaces the curve of the scenario "
            "from\n"
            "now on. Raises InputError for a number that is not finite.")
        .def("change", held(+[](const Load& load, const py::dict& definition) {
                 const scenario::Value value = value_from(definition, "");
                 driver_of(load.world).set_load(load.name, value);
                 pass_warnings(load.world);
             }),
             py::arg("definition"),
             "Put another load in the place of this one, from the next step on. definition: as of\n"
             "World.add_load(), which says what is raised.")
        .def("remove",
             held(+[](const Load& load) { driver_of(load.world).remove_load(load.name); }),
             "Remove the load, from the next step on.")
        .def("__repr__",
             held(+[](const Load& load) { return "<incise.Load '" + load.name + "'>"; }),
             "Return the name as text.");
}

}  // namespace

void register_tools(py::module_& module) {
    register_tool_contacts(module);
    register_tool(module);
    register_constraint(module);
    register_load(module);
}

}  // namespace incise::python
