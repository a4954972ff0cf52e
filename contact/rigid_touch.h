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
