// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/fitting_place.h"

#include <algorithm>
#include <array>

namespace incise::cutting {

using topology::Mesh;

namespace {

/// True if the halves of all elements round the edge, divided at `t`, keep this share of the uncut
/// body's step length.
bool is_fit(const Mesh& mesh, const EdgeRing& ring, double t, const UncutBody& uncut,
            double share) {
    const Vec3 middle = (1.0 - t) * mesh.rest_position(ring.a) + t * mesh.rest_position(ring.b);
    for (const ElementId e : ring.elements) {
        const auto before = uncut.step_length.find(mesh.region(e));
        if (before == uncut.step_length.end()) continue;
        for (const NodeId replaced : {ring.a, ring.b}) {
            std::array<Vec3, 4> x;
            for (std::size_t k = 0; k < 4; ++k) {
                const NodeId n = mesh.corners(e)[k];
                x[k] = n == replaced ? middle : mesh.rest_position(n);
            }
            if (!(element_step_length(x) >= share * before->second)) return false;
        }
    }
    return true;
}

}  // namespace

double fitting_place(const Mesh& mesh, const EdgeRing& ring, const EdgeIntersection& intersection,
                     const FitLimits& limits) {
    const auto is_fit_at = [&](double t, double share) {
        return is_fit(mesh, ring, t, limits.uncut, share);
    };
    const double place = intersection.place, share = limits.least_step_share;
    if (is_fit_at(place, share)) return place;
    const double length = (mesh.rest_position(ring.a) - mesh.rest_position(ring.b)).norm();
    const double local_edge_length =
        limits.farthest / length / (intersection.from_a + intersection.from_b);
    const double moved = place < 0.5 ? std::min(place + local_edge_length, 0.5)
                                     : std::max(place - local_edge_length, 0.5);
    if (is_fit_at(moved, share)) return moved;
    const bool is_end_near =
        std::min(intersection.from_a, intersection.from_b) * length <= limits.farthest;
    return !is_end_near && is_fit_at(moved, 0.5 * share) ? moved : -1.0;
}

}  // namespace incise::cutting
