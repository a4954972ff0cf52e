// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/surfaces/plane.h"

#include <CGAL/Mpzf.h>

#include <cmath>

namespace incise::cutting {

bool Plane::may_meet(const Box& box) const {
    const Vec3 half = 0.5 * box.sizes();
    const double radius = normal_.cwiseAbs().dot(half), offset = normal_.dot(box.center() - point_);
    // 1e-12 of this size is far above the rounding errors.
    const double size = normal_.cwiseAbs().dot(box.center().cwiseAbs() + point_.cwiseAbs() + half);
    return std::abs(offset) <= radius + 1e-12 * size;
}

int Plane::side(const Vec3& x) const {
    double value = 0.0, size = 0.0;
    for (int c = 0; c < 3; ++c) {
        const double term = normal_[c] * (x[c] - point_[c]);
        value += term;
        size += std::abs(normal_[c]) * (std::abs(x[c]) + std::abs(point_[c]));
    }
    if (std::abs(value) > 8.0 * 0x1.0p-53 * size && size > 0x1.0p-900) return value > 0.0 ? 1 : -1;
    CGAL::Mpzf exact(0.0);
    for (int c = 0; c < 3; ++c)
        exact += CGAL::Mpzf(normal_[c]) * (CGAL::Mpzf(x[c]) - CGAL::Mpzf(point_[c]));
    return CGAL::sign(exact) == CGAL::NEGATIVE ? -1 : 1;
}

void Plane::append_crossings(const MovingPoint& a, const MovingPoint& b,
                             std::vector<Crossing>& crossings) const {
    if (side(a[1]) == side(b[1])) return;
    const double from = std::abs(normal_.dot(a[1] - point_));
    const double to = std::abs(normal_.dot(b[1] - point_));
    crossings.push_back({from + to > 0.0 ? from / (from + to) : 0.5, normal_});
}

}  // namespace incise::cutting
