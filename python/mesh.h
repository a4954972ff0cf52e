// incise.Mesh, as C++ holds it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::python {

/// A mesh of Python. It does not change.
struct PyMesh {
    std::shared_ptr<const topology::MeshData> data;
    std::vector<std::string> warnings;
};

}  // namespace incise::python
