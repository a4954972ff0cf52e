// What a blade's edge sweeps in one step.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "cutting/cut_surface.h"

namespace incise::cutting {

/// A polyline whose points move straight from `before` to `after` (m).
class SweptEdge final : public CutSurface {
  public:
    /// The two have the same number of points, at least two.
    SweptEdge(std::vector<Vec3> before, std::vector<Vec3> after);

    bool may_meet(const Box& box) const override { return box_.intersects(box); }
    void append_crossings(const MovingPoint& a, const MovingPoint& b,
                          std::vector<Crossing>& crossings) const override;
    bool starts_inside(const std::array<MovingPoint, 3>& triangle) const override;
    bool ends_near(const Vec3& x, double reach) const override;

  private:
    std::vector<MovingSegment> segments_;
    std::vector<Box> boxes_;  // of the segments
    Box box_;
};

}  // namespace incise::cutting
