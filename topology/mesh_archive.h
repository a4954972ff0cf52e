// A mesh as bytes and back, with all ids, also those of what is dead.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/archive.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Cost: some 100 bytes an element, dead ones too.
void save(const Mesh& mesh, ArchiveWriter& ar);

/// Returns the mesh that save() has written: the same ids, epoch, labels and neighbours. Edits of
/// it that are recorded can be taken back.
/// Throws InputError, saying what is wrong, for bytes that are no sound mesh.
/// Cost: that of validate(), some microseconds an element.
Mesh load_mesh(ArchiveReader& ar);

}  // namespace incise::topology
