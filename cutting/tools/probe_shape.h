// Measures of the shapes of probes, in the frame of the probe.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"
#include "incise/cutting/tools/tool.h"

namespace incise::cutting {

/// Returns the box round a shape in its frame, m. That of a half space is unbounded.
Box box_of(const ProbeShape& shape);
/// Returns the least radius or half width of a shape, m; infinite for a half space. A shape that
/// moves by more than that in a step may pass through a surface.
double half_width_of(const ProbeShape& shape);
/// Returns the largest distance of the shape from the origin of its frame, m; 0 for a half space.
double reach_of(const ProbeShape& shape);

/// True if a point, m, in the frame of the shape, is within the shape. Cost for a solid: O(n) in
/// its triangles.
bool is_inside(const ProbeShape& shape, const Vec3& x);

}  // namespace incise::cutting
