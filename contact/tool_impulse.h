// What a tool exerts on the tissue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"

namespace incise::contact {

/// What a tool exerts on the tissue in a step, or in several.
struct ToolImpulse {
    Vec3 force = Vec3::Zero();   ///< N s
    Vec3 torque = Vec3::Zero();  ///< N m s, about the origin of the tool
    double work = 0.0;           ///< J
    ToolImpulse& operator+=(const ToolImpulse& other) {
        force += other.force;
        torque += other.torque;
        work += other.work;
        return *this;
    }
};

}  // namespace incise::contact
