// Conversion of a mesh to bytes and back, with all ids, including dead nodes and elements.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/archive.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Writes the mesh to an archive. Cost: some 100 bytes an element, including dead elements.
void save(const Mesh& mesh, ArchiveWriter& ar);

/// Returns the mesh that save() has written, with the same ids, epoch, labels and neighbours.
/// Recorded edits of the saved mesh can be undone on it.
///
/// Throws InputError, with the reason, if the bytes are no sound mesh.
/// Cost: that of validate(), some microseconds an element.
Mesh load_mesh(ArchiveReader& ar);

}  // namespace incise::topology
