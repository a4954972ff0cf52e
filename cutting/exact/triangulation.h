// The triangles of a face that a cut has made.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <utility>

#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Returns the ends of the edge that cuts off the next triangle of a face, in the order for
/// MeshEdit::divide_face(): the one of the best shape, as seen along the mean normal at rest. The
/// cells at the face have no other edge between these ends. Returns nothing if there is no such
/// triangle.
/// @param waits  says whether a cut waits at a corner. Such a corner is cut off only if there is no
///               other: the cut would get a node on the edge, and the face as many corners as
///               before.
std::optional<std::pair<VertexId, VertexId>> next_ear(const topology::Mesh& mesh, FaceId face,
                                                      const std::function<bool(VertexId)>& waits);

}  // namespace incise::cutting
