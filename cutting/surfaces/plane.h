// A cut surface that is an infinite plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/cutting/surfaces/cut_surface.h"

namespace incise::cutting {

/// A plane at rest, in the frame of the world.
class Plane final : public CutSurface {
  public:
    /// Makes the plane through `point`, m. The normal may have any length above 0.
    Plane(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal) {}

    bool may_meet(const Box& box) const override;
    void append_crossings(const MovingPoint& a, const MovingPoint& b,
                          std::vector<Crossing>& crossings) const override;

    bool comes_within(const Vec3& x, double distance) const override {
        return std::abs(normal_.dot(x - point_)) <= distance * normal_.norm();
    }
    SurfaceIdentity identity() const override { return identity_of_planes; }

    /// Returns the side of a point, +1 or -1, exactly. Points on the plane are on side +1.
    int side(const Vec3& x) const;

  private:
    Vec3 point_, normal_;
};

}  // namespace incise::cutting
