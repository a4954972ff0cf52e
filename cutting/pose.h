// Where a tool is.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>

#include "topology/types.h"

namespace incise::cutting {

/// Rigid placement of a tool's frame: x = rotation * local + position.
struct Pose {
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    Vec3 position = Vec3::Zero();  ///< m

    Vec3 to_world(const Vec3& local) const { return rotation * local + position; }
    Vec3 to_tool(const Vec3& world) const { return rotation.conjugate() * (world - position); }

    static void archive(auto& ar, auto& self) {
        auto& q = self.rotation.coeffs();
        ar(q.x(), q.y(), q.z(), q.w(), self.position);
    }
};

}  // namespace incise::cutting
