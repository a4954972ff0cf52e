// A cut right through along a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/cutting/surfaces/cut_surface.h"

namespace incise::cutting {

class Plane final : public CutSurface {
  public:
    /// @param normal  of any length but zero
    Plane(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal) {}

    bool may_meet(const Box& box) const override;
    void append_crossings(const MovingPoint& a, const MovingPoint& b,
                          std::vector<Crossing>& crossings) const override;

    SurfaceIdentity identity() const override { return identity_of_planes; }

    /// +1 or -1, exact; the plane itself counts as above.
    int side(const Vec3& x) const;

  private:
    Vec3 point_, normal_;
};

}  // namespace incise::cutting
