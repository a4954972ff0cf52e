// A point at which tissue touches a tool, for reports.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"

namespace incise::contact {

/// A point at which tissue exerts a force on a tool, in the last substep of a step.
struct ToolContactPoint {
    Vec3 point;           ///< on the tool, at the beginning of the substep, m
    Vec3 normal;          ///< of unit length, from the tissue to the tool; zero in jaws
    double depth;         ///< by which both overlap there, m; below 0: they meet in the substep
    Vec3 normal_force;    ///< on the tool along the normal, N
    Vec3 friction_force;  ///< on the tool, N: the rest; in jaws all of it
    int region;           ///< of the tissue
};

}  // namespace incise::contact
