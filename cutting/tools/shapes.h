// Shapes of rigid tools, in the frame of the tool.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/base/types.h"
#include "incise/topology/surface_data.h"

namespace incise::cutting {

/// A ball, m.
struct Sphere {
    double radius;  ///< centred at the origin
    static void archive(auto& ar, auto& self) { ar(self.radius); }
};
/// A cylinder with round ends, m.
struct Capsule {
    Vec3 from, to;  ///< ends of the axis
    double radius;
    static void archive(auto& ar, auto& self) { ar(self.from, self.to, self.radius); }
};
/// A box with sides parallel to the axes, m.
struct Cuboid {
    Vec3 size;  ///< edge lengths, centred at the origin
    static void archive(auto& ar, auto& self) { ar(self.size); }
};
/// What a closed surface encloses, m. See make_solid().
struct Solid {
    topology::SurfaceData surface;  ///< its triangles face outwards
    static void archive(auto& ar, auto& self) { ar(self.surface); }
};
/// All points x with (x - point) . normal <= 0: a table, a wall.
struct HalfSpace {
    Vec3 point = Vec3::Zero();    ///< m
    Vec3 normal = Vec3::UnitZ();  ///< of unit length, towards the free side
    static void archive(auto& ar, auto& self) { ar(self.point, self.normal); }
};

}  // namespace incise::cutting
