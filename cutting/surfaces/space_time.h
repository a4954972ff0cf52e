// Exact intersections of moving segments, without gaps between steps: docs/theory.md, Crossings in
// space and time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "incise/base/types.h"

namespace incise::cutting {

/// A point that moves straight during a step: [0] is its position before the step, [1] that after
/// it.
using MovingPoint = std::array<Vec3, 2>;

/// A segment between two moving points.
struct MovingSegment {
    MovingPoint a, b;
};

/// An intersection of a cut surface with a segment of tissue from a to b.
struct Crossing {
    double place;       ///< edge parameter: 0 at a, 1 at b
    Vec3 normal;        ///< of the surface there, of any length; zero if not known
    double time = 0.0;  ///< of the intersection: 0 before the step, 1 after it
    bool operator<(const Crossing& other) const { return place < other.place; }
};

/// Times in a step that differ by less than this count as equal, since rounding may separate them.
inline constexpr double at_once = 1e-9;

/// Appends the intersections of a blade's segment with a segment of tissue during the step, in no
/// particular order.
///
/// In space and time each segment sweeps a surface, taken as two triangles. Two such surfaces in
/// four dimensions meet in points, which the signs of 5 x 5 determinants decide. Where a sign is
/// zero, the tissue counts as shifted by an infinitesimal (shifted_sign.h). Neighbouring segments
/// and successive steps share their edges in space and time. So a closed path of tissue is crossed
/// consistently, whether blade or tissue moves, and however the time is divided into steps.
///
/// Whether there is an intersection is exact for any finite input. Its edge parameter and time are
/// rounded. A segment that has no length, or that is parallel to the other, has no intersection.
void append_crossings(const MovingSegment& tissue, const MovingSegment& blade,
                      std::vector<Crossing>& crossings);

/// True if the blade's segment passes through the tissue's segment an odd number of times in the
/// step.
bool cross(const MovingSegment& tissue, const MovingSegment& blade);

/// True if a blade's segment at rest from p to q passes through a triangle of tissue, with the same
/// shift. This decides which boundaries of a sweep are inside a face of the mesh.
bool pierces(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle);

}  // namespace incise::cutting
