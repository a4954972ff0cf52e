// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/passages.h"

#include <algorithm>
#include <cmath>

namespace incise::cutting {

std::vector<Crossing> crossings_of(const CutSurface& surface, const CrossableEdge& edge,
                                   double apart) {
    std::vector<Crossing> crossings;
    surface.append_crossings(edge.a, edge.b, crossings);
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size();) {
        if (crossings[i + 1].place - crossings[i].place >= apart) {
            ++i;
            continue;
        }
        const auto first = crossings.begin() + static_cast<std::ptrdiff_t>(i);
        crossings.erase(first, first + 2);
        if (i > 0) --i;
    }
    return crossings;
}

Passage passage_at(const Crossing& crossing, const CutSurface& surface, const CrossableEdge& edge,
                   const Vec3& normal_at_rest) {
    const double size = normal_at_rest.norm() * edge.at_rest.norm();
    const double steepness = size > 0.0 ? std::abs(normal_at_rest.dot(edge.at_rest)) / size : 1.0;
    const Vec3 &a = edge.a[1], &b = edge.b[1];
    Passage passage{crossing.place,
                    crossing.place * steepness,
                    (1.0 - crossing.place) * steepness,
                    crossing.time,
                    a + crossing.place * (b - a),
                    crossing.normal.normalized(),
                    normal_at_rest.normalized()};
    // Where the surface bends away its plane at the crossing would say too little.
    const double length = (b - a).norm(), at_a = surface.distance(a) / length;
    if (!std::isnan(at_a)) {
        const double at_b = surface.distance(b) / length;
        passage.from_a = std::max(passage.from_a, std::min(at_a, passage.place));
        passage.from_b = std::max(passage.from_b, std::min(at_b, 1.0 - passage.place));
    }
    return passage;
}

bool is_near(const topology::Mesh& mesh, const EdgeEnd& end, const Vec3& normal_at_rest,
             const NearLimits& limits) {
    const Vec3 x = mesh.rest_position(end.node), edge = mesh.rest_position(end.other) - x;
    const double distance = end.from * edge.norm();
    if (distance >= limits.farthest) return false;
    if (end.place < 0.5 && end.from < limits.share) return true;
    const Vec3 towards = std::copysign(1.0, normal_at_rest.dot(edge)) * normal_at_rest;
    std::vector<topology::ElementId> star;
    topology::collect_star(mesh, end.node, end.element, star);
    const auto is_long = [&](topology::NodeId n) {
        const Vec3 other = mesh.rest_position(n) - x;
        return towards.dot(other) > 2.0 * distance && distance < limits.share * other.norm();
    };
    return std::any_of(star.begin(), star.end(), [&](topology::ElementId e) {
        const auto corners = mesh.corners(e);
        return std::any_of(corners.begin(), corners.end(), is_long);
    });
}

}  // namespace incise::cutting
