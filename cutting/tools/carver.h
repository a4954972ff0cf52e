// A tool that takes away what it covers: cautery, suction, a burr.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/tissue_motion.h"
#include "incise/topology/pose.h"

namespace incise::cutting {

/// Shapes in the tool's frame, metres.
struct Sphere {
    double radius;  ///< about the origin
    static void archive(auto& ar, auto& self) { ar(self.radius); }
};
struct Capsule {
    Vec3 from, to;  ///< ends of the axis
    double radius;
    static void archive(auto& ar, auto& self) { ar(self.from, self.to, self.radius); }
};
struct Cuboid {
    Vec3 size;  ///< edge lengths, centred at the origin
    static void archive(auto& ar, auto& self) { ar(self.size); }
};
using CarverShape = std::variant<Sphere, Capsule, Cuboid>;

/// Whether the segment from a to b (tool's frame) meets the closed shape.
bool meets(const CarverShape& shape, const Vec3& a, const Vec3& b);

/// Elements whose centre the shape covers at some moment of the step, while both tool and tissue
/// move: the centre's path in the tool's frame is taken as straight. In ascending order.
/// Cost: follows what is near the tool's way, if the motion has boxes; else O(#elements).
std::vector<ElementId> covered_elements(const TissueMotion& tissue, const CarverShape& shape,
                                        const Pose& before, const Pose& after);

}  // namespace incise::cutting
