// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/shortest_inside.h"

#include <Eigen/Dense>
#include <cmath>
#include <limits>

namespace incise::cutting {

// The end of the shortest vector lies on none of the planes, on one, in an edge or in a corner.
Vec3 shortest_inside(std::span<const InnerSide> sides, double most) {
    constexpr double rounding = 1e-9;  // of the longest vector, and of 1
    Vec3 best = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    const auto try_it = [&](const Vec3& x) {
        const double length = x.norm();
        if (!(length < least) || length > most) return;
        for (const InnerSide& side : sides)
            if (side.normal.dot(x) > -side.depth + rounding * most) return;
        best = x;
        least = length;
    };
    const auto try_edge = [&](const InnerSide& a, const InnerSide& b) {
        const double cosine = a.normal.dot(b.normal), det = 1.0 - cosine * cosine;
        if (det < rounding) return;
        try_it(
            -((a.depth - cosine * b.depth) * a.normal + (b.depth - cosine * a.depth) * b.normal) /
            det);
    };
    const auto try_corner = [&](const InnerSide& a, const InnerSide& b, const InnerSide& c) {
        const Vec3 bc = b.normal.cross(c.normal), ca = c.normal.cross(a.normal),
                   ab = a.normal.cross(b.normal);
        const double det = a.normal.dot(bc);
        if (std::abs(det) < rounding) return;
        try_it(-(a.depth * bc + b.depth * ca + c.depth * ab) / det);
    };
    try_it(Vec3::Zero());
    for (std::size_t i = 0; i < sides.size(); ++i) {
        try_it(-sides[i].depth * sides[i].normal);
        for (std::size_t j = 0; j < i; ++j) {
            try_edge(sides[i], sides[j]);
            for (std::size_t k = 0; k < j; ++k) try_corner(sides[i], sides[j], sides[k]);
        }
    }
    return best;
}

}  // namespace incise::cutting
