// The surface that the edge of a blade sweeps in one step, in space and time.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/cutting/surfaces/cut_surface.h"

namespace incise::cutting {

/// The surface of a polyline whose points move straight from `before` to `after`, m.
class SweptEdge final : public CutSurface {
  public:
    /// @pre  `before` and `after` have the same number of points, at least two
    SweptEdge(std::vector<Vec3> before, std::vector<Vec3> after);

    bool is_swept() const override { return true; }
    bool may_meet(const Box& box) const override;
    bool may_meet_hull(std::span<const MovingPoint> points) const override;
    void append_crossings(const MovingPoint& a, const MovingPoint& b,
                          std::vector<Crossing>& crossings) const override;
    std::optional<bool> ends_inside(const std::array<MovingPoint, 3>& triangle) const override;
    std::optional<Vec3> end_point_inside(const std::array<MovingPoint, 3>& triangle) const override;
    bool ends_near(const Vec3& x, double radius) const override;

  private:
    /// Bounds of what a segment sweeps: a box, and two planes across `normal`.
    struct Bounds {
        Box box;
        Vec3 normal;
        double low, high;
    };

    std::vector<MovingSegment> segments_;
    std::vector<Bounds> bounds_;  // of the segments
};

}  // namespace incise::cutting
