// Whether a recorded edit that comes from a file is one of this mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "topology/change_set.h"
#include "topology/mesh.h"

namespace incise::topology {

/// Throws InputError, saying what is wrong, unless replay() of the edit would read and change only
/// what is there: ids, kinds and regions are right, elements have the corners and neighbours that
/// the record says they lose, and faces that are joined have the same nodes. Whether the mesh is
/// sound afterwards validate() tells.
/// @param changes  of MeshEdit::commit, on the mesh as it stands; no inverse of such
/// Cost: proportional to the edit.
void require_fit(const ChangeSet& changes, const Mesh& mesh);

}  // namespace incise::topology
