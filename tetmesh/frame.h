// The coordinates in which a mesh is made: any unit and any place are the same to the mesher.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cmath>
#include <utility>

#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// Coordinates from the centre of a body, over a power of two that is about its longest side. Far
/// from the origin, or in a unit of which products are no numbers, Mesh_3 would fail.
class Frame {
  public:
    explicit Frame(const Box& box)
        : centre_(box.center()), unit_(std::exp2(std::ilogb(box.sizes().maxCoeff()))) {}

    double local(double length) const { return length / unit_; }
    Vec3 local(const Vec3& x) const { return (x - centre_) / unit_; }
    Vec3 given(const Vec3& x) const { return centre_ + unit_ * x; }

    BodyShape local(BodyShape body) const {
        for (auto& [region, volume] : body.volumes) volume = local(local(local(volume)));
        body.area = local(local(body.area));
        body.roughness = local(body.roughness);
        body.box = Box(local(body.box.min()), local(body.box.max()));
        for (PartPoints& part : body.first_points)
            for (Vec3& x : part.points) x = local(x);
        for (auto& line : body.sharp_edges)
            for (Vec3& x : line) x = local(x);
        body.region_at = [frame = *this, region_at = std::move(body.region_at)](const Vec3& x) {
            return region_at(frame.given(x));
        };
        return body;
    }

  private:
    Vec3 centre_;
    double unit_;
};

}  // namespace incise::tetmesh
