// The extension module incise._incise.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <pybind11/pybind11.h>

#include "incise/python/handle.h"

PYBIND11_MODULE(_incise, module) {
    namespace python = incise::python;
    module.doc() = "The compiled part of incise: use the package incise.";
    module.attr("__version__") = INCISE_VERSION;
    python::Unlocked::register_end();
    python::register_errors(module);
    python::register_pose(module);
    python::register_mesh(module);
    python::register_cut(module);
    python::register_report(module);
    python::register_tools(module);
    python::register_world(module);
}
