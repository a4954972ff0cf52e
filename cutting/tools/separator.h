// A blade that opens faces which exist: the cut runs along the mesh, next to the blade's path.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// Faces to open after a blade's edge, a polyline, moved straight from `before` to `after` (m)
/// while the tissue moved too. In ascending order.
///
/// A face is opened when the edge passed, an odd number of times, through the path that joins the
/// centres of its two elements by way of a point of the face. These paths run inside the body, and
/// crossings are counted exactly (space_time.h): once the blade has passed right through, no chain
/// of elements leads past it, so the body is parted; until then the opened faces are a sheet that
/// ends at the blade, within one element of where it went. An element that had several neighbours
/// is not cut off alone: it would be a sliver, its centre beyond the blade and the rest of it not.
/// Cost: follows what is near the blade's way, if the motion has boxes; else O(#elements).
std::vector<FaceId> faces_to_open(const TissueMotion& tissue, std::span<const Vec3> before,
                                  std::span<const Vec3> after);

}  // namespace incise::cutting
