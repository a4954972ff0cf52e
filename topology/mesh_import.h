// How plain arrays become a mesh. Internal to topology; see Mesh::build().
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "incise/topology/diagonals.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_check.h"

namespace incise::topology {

struct ImportRules {
    WeldAdvice advice = {};
    /// The faces that are joined, where the source knows them; else those with the same corners.
    std::optional<std::vector<SharedFace>> shared_faces = {};
    /// With shared_faces: the diagonals of each cell, and the triangles that each divided face is
    /// joined to. Both are empty if there are none.
    std::vector<Diagonals> diagonals = {};
    std::vector<std::pair<SourceFace, SourceFace>> joined_triangles = {};
    /// True if cells and used points keep their order, as those of data with carriers do.
    bool keeps_order = false;
};

/// Builds a mesh as Mesh::build() does.
BuiltMesh import_mesh(const MeshData& data, ImportRules rules);

}  // namespace incise::topology
