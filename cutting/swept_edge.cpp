// SPDX-License-Identifier: LGPL-3.0-or-later
#include "cutting/swept_edge.h"

#include <algorithm>
#include <cstddef>

namespace incise::cutting {

SweptEdge::SweptEdge(std::vector<Vec3> before, std::vector<Vec3> after) {
    for (std::size_t s = 0; s + 1 < before.size(); ++s) {
        segments_.push_back({{before[s], after[s]}, {before[s + 1], after[s + 1]}});
        Box box(before[s]);
        box.extend(after[s]).extend(before[s + 1]).extend(after[s + 1]);
        boxes_.push_back(box);
        box_.extend(box);
    }
}

void SweptEdge::append_crossings(const MovingPoint& a, const MovingPoint& b,
                                 std::vector<Crossing>& crossings) const {
    Box path(a[0]);
    path.extend(a[1]).extend(b[0]).extend(b[1]);
    for (std::size_t s = 0; s < segments_.size(); ++s)
        if (boxes_[s].intersects(path)) cutting::append_crossings({a, b}, segments_[s], crossings);
}

bool SweptEdge::starts_inside(const std::array<MovingPoint, 3>& triangle) const {
    bool is_odd = false;
    for (const MovingSegment& s : segments_)
        is_odd ^= pierces(s.a[0], s.b[0], {triangle[0][0], triangle[1][0], triangle[2][0]});
    return is_odd;
}

bool SweptEdge::ends_near(const Vec3& x, double reach) const {
    for (const MovingSegment& s : segments_) {
        const Vec3 along = s.b[1] - s.a[1], from = x - s.a[1];
        const double square = along.squaredNorm();
        const double t = square > 0.0 ? std::clamp(from.dot(along) / square, 0.0, 1.0) : 0.0;
        if ((from - t * along).squaredNorm() < reach * reach) return true;
    }
    return false;
}

}  // namespace incise::cutting
