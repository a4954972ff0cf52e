// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/momentum.h"

#include <Eigen/Eigenvalues>

namespace incise::physics {

RigidVelocity rigid_change(std::span<const MassPoint> points, const Momenta& momenta) {
    double mass = 0.0;
    Vec3 centre = Vec3::Zero();
    for (const MassPoint& point : points) {
        mass += point.mass;
        centre += point.mass * point.x;
    }
    if (mass == 0.0) return {};
    centre /= mass;
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  // about the centre
    for (const MassPoint& point : points) {
        const Vec3 r = point.x - centre;
        inertia += point.mass * (r.squaredNorm() * Eigen::Matrix3d::Identity() - r * r.transpose());
    }
    const Vec3 spin = momenta.angular - centre.cross(momenta.linear);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
    RigidVelocity change;
    constexpr double rounding = 1e-10;
    for (int k = 0; k < 3; ++k) {
        const Vec3 axis = axes.eigenvectors().col(k);
        if (axes.eigenvalues()[k] > rounding * axes.eigenvalues()[2])
            change.angular += axis.dot(spin) / axes.eigenvalues()[k] * axis;
    }
    change.linear = momenta.linear / mass - change.angular.cross(centre);
    return change;
}

}  // namespace incise::physics
