// Where a rigid shape and a triangle are closest. Internal to contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/tools/tool.h"

namespace incise::contact {

/// The point of a triangle that is closest to a shape, or deepest in it.
struct RigidTouch {
    Vec3 weights;                  ///< of the corners of the triangle; they sum to 1
    Vec3 point;                    ///< m, in the frame of the shape
    Vec3 normal;                   ///< of unit length, out of the shape, in its frame
    double gap = 0.0;              ///< distance along the normal, m; below 0: they overlap
    std::int32_t tool_point = -1;  ///< of a solid: its number, if one of its points touches
};

/// Returns the box round a shape in its frame, m. That of a half space is unbounded.
Box box_of(const cutting::ProbeShape& shape);
/// Returns the least radius or half width of a shape, m; infinite for a half space. A shape that
/// moves by more than that in a step may pass through a surface.
double half_width_of(const cutting::ProbeShape& shape);
/// Returns the largest distance of the shape from the origin of its frame, m; 0 for a half space.
double reach_of(const cutting::ProbeShape& shape);

/// True if a point, m, in the frame of the shape, is within the shape. Cost for a solid: O(n) in
/// its triangles.
bool is_inside(const cutting::ProbeShape& shape, const Vec3& x);

/// Returns the weights of the corners of a triangle of its point that is closest to `x`.
Vec3 closest_weights(const std::array<Vec3, 3>& corners, const Vec3& x);

/// Appends where a shape and a triangle are closest, if that is not farther than `farthest`, m, and
/// the triangle has an area. For shapes with flat sides, so far as they are within that distance,
/// appends the corners of the triangle as well.
/// @param shape    any but a solid: see RigidSolid
/// @param corners  in the frame of the shape, anticlockwise as seen from outside the tissue. If the
///                 axis of a ball or a capsule is within the tissue, the normal is that of the
///                 triangle.
void append_touches(const cutting::ProbeShape& shape, const std::array<Vec3, 3>& corners,
                    double farthest, std::vector<RigidTouch>& touches);

}  // namespace incise::contact
