// Archives of the fragments of a mesh, as checkpoints store them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/archive.h"
#include "incise/fragments/fragment_mesh.h"

namespace incise::fragments {

/// Writes everything but the mesh itself. Cost: some 60 bytes an element and 30 a node.
void save(const FragmentMesh& fragments, ArchiveWriter& ar);

/// Reads what save() has written. The result equals the saved object.
/// Throws InputError for data that are not those of fragments of this mesh: see validate().
/// @param material  the mesh, after the edits that the saved object has followed
FragmentMesh load_fragments(const topology::Mesh& material, ArchiveReader& ar);

}  // namespace incise::fragments
