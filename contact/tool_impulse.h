// What a tool exerts on the tissue.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"

namespace incise::contact {

/// What a tool exerts on the tissue in a step, or in several.
struct ToolImpulse {
    Vec3 force = Vec3::Zero();   ///< N s
    Vec3 torque = Vec3::Zero();  ///< N m s, about the origin of the tool
    double work = 0.0;           ///< on the tissue, J
    double fracture = 0.0;       ///< energy that it took to cut, J
    ToolImpulse& operator+=(const ToolImpulse& other) {
        force += other.force;
        torque += other.torque;
        work += other.work;
        fracture += other.fracture;
        return *this;
    }
};

}  // namespace incise::contact
