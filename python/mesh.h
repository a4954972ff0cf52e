// incise.Mesh, as C++ holds it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "incise/python/handle.h"
#include "incise/topology/mesh_data.h"

namespace incise::python {

/// A mesh of Python. It does not change.
struct PyMesh {
    std::shared_ptr<const topology::MeshData> data;
    std::vector<std::string> warnings;
};

using Integers = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>;
/// Returns an array of whole numbers. Throws TypeError that names it for others.
Integers integers_from(const py::handle& object, const std::string& name);

}  // namespace incise::python
