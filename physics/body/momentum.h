// Momenta of the nodes near an edit, and their restoration after it.
// Source: docs/theory.md, Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::physics {

/// Linear momentum, kg m/s, and angular momentum about the origin, kg m2/s.
struct Momenta {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();

    /// Adds a mass, kg, with a velocity, m/s, at `x`, m.
    void add(double mass, const Vec3& x, const Vec3& velocity) {
        const Vec3 p = mass * velocity;
        linear += p;
        angular += x.cross(p);
    }
    Momenta operator-(const Momenta& o) const { return {linear - o.linear, angular - o.angular}; }
};

/// A mass point.
struct MassPoint {
    double mass;  ///< kg
    Vec3 x;       ///< m
};

/// A rigid change of velocities, v(x) = linear + angular x x, in m/s and 1/s.
struct RigidVelocity {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    Vec3 at(const Vec3& x) const { return linear + angular.cross(x); }
};

/// Returns the rigid change of velocities of mass points that changes their momenta by the given
/// ones. If the points are on a line, their rotation about it stays as it is.
RigidVelocity rigid_change(std::span<const MassPoint> points, const Momenta& momenta);

}  // namespace incise::physics
