// A blade that opens existing faces next to its path.
// Source: [Nienhuys 2001] in docs/glossary.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// Returns the faces to open after a blade's edge has moved straight from `before` to `after`,
/// while the tissue moved too. The edge is a polyline, m. The faces are in ascending order.
///
/// A face opens if the edge passes an odd number of times through the path between the centres of
/// its two elements. The path goes by way of a point of the face, so it lies inside the body.
/// Intersections are counted exactly (space_time.h). Once the blade has passed right through, no
/// chain of elements leads past it, so the body comes apart. Until then the opened faces are a
/// sheet that ends at the blade, within one element of its path.
///
/// An element that had several neighbours is not separated alone. Its centre would be beyond the
/// blade and the rest of it not, so it would be a sliver.
/// Cost: proportional to the elements near the path of the blade if `tissue` has boxes, else O(n).
std::vector<FaceId> faces_to_open(const TissueMotion& tissue, std::span<const Vec3> before,
                                  std::span<const Vec3> after);

}  // namespace incise::cutting
