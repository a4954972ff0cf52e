// The way of a blade through a body, for tests.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "split_body.h"
#include "support/mesh_families.h"

namespace incise::cutting {

/// A bent edge that sweeps in a plane, right through the body or to a share of the way.
struct BladePath {
    Vec3 point, normal;
    Polyline from, to;

    BladePath(const Box& box, test::Random& random, double share = 1.0) {
        const double size = box.diagonal().norm();
        point = box.center() + random.vector(0.05 * size);
        normal = random.vector(1.0).normalized();
        const Vec3 u = 1.5 * size * normal.unitOrthogonal(), v = normal.cross(u);
        for (const double s : {-1.0, 0.1, 1.0}) {
            const double ahead = random.uniform(-0.1, 0.1);
            from.push_back(point + s * u + (ahead - 1.0) * v);
            to.push_back(point + s * u + (ahead - 1.0 + 2.0 * share) * v);
        }
    }
};

}  // namespace incise::cutting
