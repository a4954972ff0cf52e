// Tools at random that cut the unit cube at rest.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/cutting/rest/cut_at_rest.h"
#include "support/mesh_families.h"

namespace incise::cutting {

inline RestTool random_plane(test::Random& random) {
    Vec3 point;
    for (double& x : point) x = random.uniform(0.2, 0.8);
    return {"plane", PlaneCut{point, random.vector(1.0)}};
}

/// A straight blade.
/// @param end  where it stops: how far behind a place near the middle of the cube
inline RestTool random_blade(test::Random& random, double end) {
    const Vec3 along = random.vector(1.0).normalized();
    const Vec3 ahead = along.cross(random.vector(1.0)).normalized();
    const Vec3 middle = Vec3::Constant(0.5) + random.vector(0.2);
    Sweep sweep;
    for (int i = 0; i <= 4; ++i) {
        const Vec3 at = middle + (-1.5 + (end + 1.5) * i / 4) * ahead;
        sweep.poses.push_back({at - 2.0 * along, at + 2.0 * along});
    }
    return {"sweep", sweep};
}

/// A straight blade that goes through the body, or stops inside.
inline RestTool random_blade(test::Random& random) {
    const double end = random.below(2) == 0 ? 2.0 : random.uniform(-0.2, 0.2);
    return random_blade(random, end);
}

}  // namespace incise::cutting
