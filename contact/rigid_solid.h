// A rigid tool in the form of a closed surface. Internal to contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/contact/rigid_touch.h"
#include "incise/contact/surface_tree.h"
#include "incise/cutting/tools/shapes.h"

namespace incise::contact {

/// Finds where a closed surface and triangles of tissue touch: corners of the tissue on faces of
/// the surface, and points of the surface on triangles of the tissue. Edges that cross between
/// their ends are left out.
class RigidSolid {
  public:
    /// Cost: O(n log n).
    explicit RigidSolid(const cutting::Solid& solid);

    /// As the function append_touches() for other shapes. Cost: that of the triangles within
    /// `farthest`, m.
    void append_touches(const std::array<Vec3, 3>& corners, double farthest,
                        std::vector<RigidTouch>& touches) const;

  private:
    using Corners = std::array<Vec3, 3>;
    /// A point of the surface that is nearest to another one.
    struct Nearest {
        Vec3 point = Vec3::Zero();
        Vec3 normal = Vec3::Zero();  ///< angle-weighted mean at the point, outward
    };
    Corners corners_of(std::uint32_t triangle) const;
    bool find_nearest(const Vec3& x, double farthest, Nearest& nearest) const;
    void append_corner(const Corners& corners, int k, double farthest,
                       std::vector<RigidTouch>& touches) const;
    void append_points(const Corners& corners, double farthest,
                       std::vector<RigidTouch>& touches) const;

    std::vector<Vec3> points_;
    std::vector<Triangle> triangles_;  // numbers of points as node ids
    SurfaceTree tree_;
    std::vector<Vec3> point_normals_;                // by point
    std::vector<std::array<Vec3, 3>> edge_normals_;  // by triangle and edge, from corner k on
};

}  // namespace incise::contact
