// The mesh that a scenario names: read from its file, or made as a box.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "incise/scenario/scenario.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Cell arrays of a mesh file.
struct CellVectors {
    std::string file;
    std::map<std::string, std::vector<Vec3>> by_name;  ///< one vector for each label of an element
};

/// The mesh of a scenario, with what its file says of the cells.
struct SourceMesh {
    topology::Mesh mesh;
    std::vector<std::string> warnings;
    CellVectors cell_vectors;
};

/// Reads or makes the scenario's mesh, with the cell arrays that materials name. Warnings name the
/// file.
/// Throws InputError with every problem found, each line naming the file; BodyError if the scale or
/// the box are at fault.
SourceMesh build_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials);

/// "[1, 2.5, 0]", for messages.
std::string vector_text(const Vec3& v);

}  // namespace incise::scenario
