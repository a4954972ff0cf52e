// The mesh of a scenario, read from a file or generated as a box.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "incise/scenario/scenario.h"
#include "incise/topology/mesh.h"

namespace incise::scenario {

/// Cell arrays of vectors in a mesh file.
struct CellVectors {
    std::string file;
    std::map<std::string, std::vector<Vec3>> by_name;  ///< indexed by the labels of the elements
};

/// The mesh of a scenario, with the cell arrays of its file.
struct SourceMesh {
    topology::Mesh mesh;
    std::vector<std::string> warnings;
    CellVectors cell_vectors;
    std::vector<std::string> joins;  ///< see topology::BuiltMesh
};

/// Reads or generates the mesh of a scenario, and reads the cell arrays that the materials name.
/// Warnings name the file.
/// Throws InputError with every problem of the file, one a line with its name. Throws BodyError if
/// the scale, the box, the region array or the built mesh is faulty. Throws MemoryError if the
/// machine has too little memory for the box.
SourceMesh build_mesh(const MeshSpec& spec, const std::vector<MaterialSpec>& materials);

/// Returns a vector as text for messages, such as "[1, 2.5, 0]".
std::string vector_text(const Vec3& v);

}  // namespace incise::scenario
