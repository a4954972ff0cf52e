// incise.StepReport.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <sstream>

#include "incise/python/handle.h"
#include "incise/python/records.h"
#include "incise/runner/edit_line.h"

namespace incise::python {

py::list edits_of(std::span<const sim::EditRecord> edits) {
    const py::object loads = py::module_::import("json").attr("loads");
    py::list list;
    for (const sim::EditRecord& edit : edits) list.append(loads(runner::edit_line(edit)));
    return list;
}

namespace {
py::dict by_tool(const Report& report, const std::vector<Vec3>& values) {
    py::dict dict;
    for (std::size_t i = 0; i < values.size(); ++i)
        dict[py::str(report.tools->names[i])] = array_of(values[i]);
    return dict;
}
}  // namespace

void register_report(py::module_& module) {
    py::class_<Report, std::shared_ptr<Report>> type(
        module, "StepReport",
        R"(What a call of World.step() or World.run_until() did.

A report keeps its values: later steps do not change it.)");
    type.attr("__module__") = "incise";
    forbid_copies(type, "keep its values");
    type.def_property_readonly("start", held(&Report::from),
                               "Time at the beginning of the call, s.")
        .def_property_readonly("end", held(&Report::to), "Time at its end, s.")
        .def_property_readonly("num_steps", held(&Report::num_steps),
                               "Number of steps of the call.")
        .def_property_readonly(
            "num_substeps", held(&Report::num_substeps),
            "Number of explicit steps that these were divided into. More than num_steps\n"
            "where strain or a fast probe needs shorter ones.")
        .def_property_readonly(
            "edits", held(+[](const Report& report) { return edits_of(report.edits); }),
            "The edits of the mesh, in their order: a list of dicts, as World.edits().")
        .def_property_readonly(
            "tool_forces",
            held(+[](const Report& report) { return by_tool(report, report.forces); }),
            "What the tissue exerted on each probe, grasper, suture, and blade with a toughness:\n"
            "a dict by name of arrays (3,), N, in the frame of the world, means over the call.")
        .def_property_readonly("tool_torques", held(+[](const Report& report) {
                                   return by_tool(report, report.torques);
                               }),
                               "The same for torques about the origins of the tools, N m.")
        .def_property_readonly(
            "contacts", held(+[](const Report& report) { return report.contact.num_points; }),
            "Number of points of contact in the last step.")
        .def_property_readonly("max_penetration", held(&Report::max_penetration),
                               "Largest overlap of surfaces during the call, m.")
        .def("__repr__", held(+[](const Report& report) {
                 std::ostringstream text;
                 text << "<incise.StepReport: " << report.from << " s to " << report.to << " s, "
                      << report.num_steps << (report.num_steps == 1 ? " step, " : " steps, ")
                      << report.edits.size() << (report.edits.size() == 1 ? " edit>" : " edits>");
                 return text.str();
             }),
             "Return times and numbers as text.");
}

}  // namespace incise::python
