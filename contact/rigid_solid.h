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
/// the surface, points of the surface on triangles of the tissue, and edges that cross.
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
    /// An edge at which the surface is convex.
    struct Edge {
        VertexId from, to;
        std::array<Vec3, 2> normals;  ///< of its triangles, of unit length
    };
    bool find_nearest(const Vec3& x, double farthest, Nearest& nearest) const;
    void leave_by_facing_side(const Vec3& x, const Vec3& outward, double farthest,
                              Nearest& nearest) const;
    void append_corner(const Corners& corners, int k, const Vec3& outward, double farthest,
                       std::vector<RigidTouch>& touches) const;
    void append_point(const Corners& corners, const Vec3& outward, VertexId p, double farthest,
                      std::vector<RigidTouch>& touches) const;
    void append_edge(const Corners& corners, const Vec3& outward, std::size_t edge, double farthest,
                     std::vector<RigidTouch>& touches) const;

    std::vector<Vec3> points_;
    Box extent_;
    std::vector<Triangle> triangles_;  // numbers of points as node ids
    SurfaceTree tree_;
    std::vector<Vec3> point_normals_;                // by point
    std::vector<std::array<Vec3, 3>> edge_normals_;  // by triangle and edge, from corner k on
    std::vector<Edge> edges_;
    // Points and edges by triangle, each at one of its triangles.
    std::vector<std::vector<VertexId>> points_of_;
    std::vector<std::vector<std::size_t>> edges_of_;
};

}  // namespace incise::contact
