// The pose of a rigid frame.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "incise/base/types.h"

namespace incise {

/// Position and orientation of a rigid frame: x = rotation * local + position.
struct Pose {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 position = Vec3::Zero();  ///< m

    /// Transforms a point from the frame to the world, m.
    Vec3 to_world(const Vec3& local) const { return rotation * local + position; }
    /// Transforms a point from the world to the frame, m.
    Vec3 to_tool(const Vec3& world) const { return rotation.conjugate() * (world - position); }

    /// True if the position is finite and the rotation has unit length to rounding.
    bool is_sound() const {
        return position.allFinite() && std::abs(rotation.squaredNorm() - 1.0) < 1e-6;
    }

    static void archive(auto& ar, auto& self) {
        auto& q = self.rotation.coeffs();
        ar(q.x(), q.y(), q.z(), q.w(), self.position);
    }
};

/// Returns the pose between `a` (s = 0) and `b` (s = 1). The position is interpolated linearly, the
/// orientation along the shortest rotation.
inline Pose interpolate(const Pose& a, const Pose& b, double s) {
    return {a.rotation.slerp(s, b.rotation), a.position + s * (b.position - a.position)};
}

}  // namespace incise
