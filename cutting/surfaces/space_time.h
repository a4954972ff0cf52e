// Whether and where moving things met: exact, and without gaps from step to step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "incise/base/types.h"

namespace incise::cutting {

/// A point that moves straight during a step: [0] is where it is before, [1] after.
using MovingPoint = std::array<Vec3, 2>;

/// A segment between two moving points.
struct MovingSegment {
    MovingPoint a, b;
};

/// Where a cut passes through a segment of tissue from a to b.
struct Crossing {
    double place;       ///< 0 at a, 1 at b
    Vec3 normal;        ///< of the cut there, of any length but zero, unless it is not known
    double time = 0.0;  ///< of the intersection: 0 before the step, 1 after it
    bool operator<(const Crossing& other) const { return place < other.place; }
};

/// Of a step: what is nearer to each other in time happens at once, but for rounding.
inline constexpr double at_once = 1e-9;

/// Appends where the blade's segment passed through the tissue's during the step, in no order.
///
/// In space and time each segment sweeps a surface, taken as two triangles; two such surfaces in
/// four dimensions meet in points, which are found by the signs of 5 x 5 determinants. Where a
/// sign is zero, the tissue counts as shifted by an infinitesimal (shifted_sign.h). Neighbouring
/// segments, and successive steps, share their edges in space and time: a closed path of tissue is
/// crossed consistently, whoever moves and however the step is chosen.
///
/// Whether there is a crossing is exact for any finite input; the places are rounded. A zero-length
/// or parallel segment crosses nothing.
void append_crossings(const MovingSegment& tissue, const MovingSegment& blade,
                      std::vector<Crossing>& crossings);

/// Whether the blade's segment passed through the tissue's an odd number of times in the step.
bool cross(const MovingSegment& tissue, const MovingSegment& blade);

/// Whether the resting segment of a blade from p to q passes through the triangle of tissue, with
/// the same shift: what fronts of a sweep are inside a face of the mesh.
bool pierces(const Vec3& p, const Vec3& q, const std::array<Vec3, 3>& triangle);

}  // namespace incise::cutting
