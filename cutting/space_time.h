// Whether moving things met: exact, and without gaps from step to step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>

#include "topology/types.h"

namespace incise::cutting {

/// A segment whose ends move straight during a step: [0] is where they are before, [1] after.
struct MovingSegment {
    std::array<Vec3, 2> a, b;
};

/// Whether the blade's segment passed through the tissue's an odd number of times in the step.
///
/// In space and time each segment sweeps a surface, taken as two triangles; two such surfaces in
/// four dimensions meet in points, which are counted by the signs of 5 x 5 determinants. Where a
/// sign is zero, the tissue counts as shifted by an infinitesimal (e, e^2, e^4) relative to the
/// blade: one and the same shift for all tissue at all times, so that every case is decided once,
/// from every side alike. Neighbouring segments, and successive steps, share their edges in space
/// and time: a closed path of tissue is crossed consistently, whoever moves and however the step
/// is chosen.
///
/// Exact for any finite input; a zero-length or parallel segment crosses nothing.
bool cross(const MovingSegment& tissue, const MovingSegment& blade);

}  // namespace incise::cutting
