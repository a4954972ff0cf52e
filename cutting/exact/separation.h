// Decides which faces open along a cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/sides.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Returns the faces between the two sides of a cut (Sides::separated_faces()), in ascending order.
/// Faces between frozen nodes (CutFront::freeze()) stay joined.
/// @param mesh          during the edit
/// @param front         of the cut
/// @param touched       the elements to look at: all that the edit has changed, and possibly others
/// @param place_on_cut  see Sides
std::vector<FaceId> faces_to_separate(const topology::Mesh& mesh, const CutFront& front,
                                      const std::vector<CellId>& touched,
                                      const PlaceOnCut& place_on_cut);

}  // namespace incise::cutting
