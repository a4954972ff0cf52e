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
    Vec3 weights;      ///< of the corners of the triangle; they sum to 1
    Vec3 point;        ///< m, in the frame of the shape
    Vec3 normal;       ///< of unit length, out of the shape, in its frame
    double gap = 0.0;  ///< distance along the normal, m; below 0: they overlap
    /// Of a solid, the number of its point that touches, or its number of points and that of the
    /// edge that does.
    std::int32_t tool_feature = -1;
};

/// Returns the weights of the corners of a triangle of its point that is closest to `x`.
Vec3 closest_weights(const std::array<Vec3, 3>& corners, const Vec3& x);

/// Returns the part of the way from p to q at which the segment is closest to another one, a to b,
/// and the same on that one.
std::array<double, 2> closest_of_segments(const Vec3& p, const Vec3& q, const Vec3& a,
                                          const Vec3& b);

/// Appends where a shape and a triangle are closest, if that is not farther than `farthest`, m, and
/// the triangle has an area. For a half space, appends all corners that are within that distance.
/// @param shape    any but a box or a solid: see RigidSolid
/// @param corners  in the frame of the shape, anticlockwise as seen from outside the tissue. If the
///                 axis of a ball or a capsule is within the tissue, the normal is that of the
///                 triangle.
void append_touches(const cutting::ProbeShape& shape, const std::array<Vec3, 3>& corners,
                    double farthest, std::vector<RigidTouch>& touches);

}  // namespace incise::contact
