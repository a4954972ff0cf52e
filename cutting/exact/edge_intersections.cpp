// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/edge_intersections.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

std::vector<Crossing> crossings_of(const CutSurface& surface, const CrossableEdge& edge,
                                   double apart) {
    std::vector<Crossing> crossings;
    surface.append_crossings(edge.a, edge.b, crossings);
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size();) {
        if (crossings[i + 1].place - crossings[i].place >= apart ||
            std::abs(crossings[i + 1].time - crossings[i].time) > at_once) {
            ++i;
            continue;
        }
        const auto first = crossings.begin() + static_cast<std::ptrdiff_t>(i);
        crossings.erase(first, first + 2);
        if (i > 0) --i;
    }
    return crossings;
}

EdgeIntersection intersection_at(const Crossing& crossing, const CutSurface& surface,
                                 const CrossableEdge& edge, const Vec3& normal_at_rest) {
    const double size = normal_at_rest.norm() * edge.at_rest.norm();
    const double steepness = size > 0.0 ? std::abs(normal_at_rest.dot(edge.at_rest)) / size : 1.0;
    const Vec3 &a = edge.a[1], &b = edge.b[1];
    EdgeIntersection intersection{crossing.place,
                                  crossing.place * steepness,
                                  (1.0 - crossing.place) * steepness,
                                  crossing.time,
                                  a + crossing.place * (b - a),
                                  crossing.normal.normalized(),
                                  normal_at_rest.normalized()};
    // Where the surface bends away, its plane at the intersection gives distances that are too
    // small.
    const double length = (b - a).norm(), at_a = surface.distance(a) / length;
    if (!std::isnan(at_a)) {
        const double at_b = surface.distance(b) / length;
        intersection.from_a = std::max(intersection.from_a, std::min(at_a, intersection.place));
        intersection.from_b =
            std::max(intersection.from_b, std::min(at_b, 1.0 - intersection.place));
    }
    return intersection;
}

}  // namespace incise::cutting
