// What an incise.World is made from: a scenario file, or dicts with its keys.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/python/handle.h"

namespace incise::python {

/// Makes a world from a scenario or from its sections one by one; the docstring of World has what
/// each may be. Throws InputError with all faults of scenario and mesh.
World make_world(const py::object& scenario, const py::object& mesh, const py::object& materials,
                 const py::object& constraints, const py::object& loads, const py::object& tools,
                 const py::object& obstacles, const py::object& dynamics, const py::object& contact,
                 const py::object& output, const py::object& gravity, const py::object& damping,
                 const py::object& overrides, const py::object& folder, int num_threads,
                 const py::kwargs& unknown);

}  // namespace incise::python
