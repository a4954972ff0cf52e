// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/edge_intersections.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

EdgeIntersections intersections_of(const CutSurface& surface, const MovingPoint& a,
                                   const MovingPoint& b, double apart) {
    std::vector<Crossing> crossings;
    surface.append_crossings(a, b, crossings);
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
    EdgeIntersections intersections;
    intersections.reserve(crossings.size());
    for (const Crossing& crossing : crossings)
        intersections.push_back({crossing.place, crossing.time,
                                 a[1] + crossing.place * (b[1] - a[1]),
                                 crossing.normal.normalized()});
    return intersections;
}

}  // namespace incise::cutting
