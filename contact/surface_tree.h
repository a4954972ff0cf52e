// A tree of boxes round the triangles of a surface, to find those that face a point near it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::contact {

using Triangle = std::array<VertexId, 3>;

/// The surface of a body.
struct TissueSurface {
    std::span<const Triangle> triangles;  ///< outward
    std::span<const FaceId> faces;        ///< of the mesh, by triangle
};

/// The directions of the normals of some triangles: a cone about an axis.
struct NormalCone {
    Vec3 axis = Vec3::Zero();
    double half_angle = -1.0;  ///< rad; below 0: no triangles; pi: all directions

    /// Makes the cone contain another one.
    void include(const NormalCone& other);
};

/// A binary tree over the triangles of a surface. The order of the triangles is that of their
/// places at rest along a space-filling curve. So an edit of the surface only inserts and removes
/// entries, and motion only changes boxes.
class SurfaceTree {
  public:
    /// Sets the triangles anew. Cost: O(n log n) in the number of triangles.
    /// @param triangles       of node ids
    /// @param rest_positions  by vertex id, m
    void set_triangles(std::span<const Triangle> triangles, std::span<const Vec3> rest_positions);
    /// Sets the boxes for new positions, by vertex id, m. Cost: O(n).
    void fit(std::span<const Vec3> positions);

    /// Calls visit(t) for each triangle whose box overlaps `box`, and whose normal differs from one
    /// of some directions by more than a right angle. Also for some whose normal does not. The
    /// order of the calls depends on nothing but the surface and the positions.
    template <class Visit>
    void for_each_against(const Box& box, const NormalCone& directions, Visit visit) const {
        if (!order_.empty()) visit_against(1, box, Directions(directions), visit);
    }

    std::span<const Triangle> triangles() const { return triangles_; }
    /// Returns the triangles in the order of the curve.
    std::span<const std::uint32_t> order() const { return order_; }
    const Box& box(std::size_t t) const { return boxes_[t]; }
    /// Returns the unit normal of a triangle, outward, at the positions of the last fit. It is zero
    /// for a triangle without area.
    const Vec3& normal(std::size_t t) const { return normals_[t]; }

  private:
    static constexpr std::size_t leaf_size = 4;
    /// A cone that is compared with others.
    struct Directions {
        Vec3 axis = Vec3::Zero();
        double cosine = -1.0, sine = 0.0;  // of the half angle

        Directions() = default;
        explicit Directions(const NormalCone& cone);
        /// True if a direction of each may differ by more than a right angle.
        bool may_oppose(const Directions& other) const {
            const double cosine_of_sum = cosine * other.cosine - sine * other.sine;
            const double sine_of_sum = sine * other.cosine + cosine * other.sine;
            return cosine_of_sum <= 0.0 || cosine <= 0.0 || other.cosine <= 0.0 ||
                   axis.dot(other.axis) <= sine_of_sum;
        }
    };
    struct Branch {
        Box box;
        Directions normals;
    };
    std::size_t leaf_begin(std::size_t branch) const { return (branch - num_leaves_) * leaf_size; }
    std::size_t leaf_end(std::size_t branch) const {
        return std::min(leaf_begin(branch) + leaf_size, order_.size());
    }
    template <class Visit>
    void visit_against(std::size_t branch, const Box& box, const Directions& directions,
                       Visit& visit) const;

    std::vector<Triangle> triangles_;
    std::vector<std::uint32_t> order_;  // of the triangles in the tree
    std::vector<Box> boxes_;            // by triangle
    std::vector<Vec3> normals_;         // by triangle
    std::size_t num_leaves_ = 0;        // a power of two
    std::vector<Branch> branches_;      // 1 is the root; the children of k are 2 k and 2 k + 1
    std::vector<NormalCone> cones_;     // scratch, by branch
};

template <class Visit>
void SurfaceTree::visit_against(std::size_t branch, const Box& box, const Directions& directions,
                                Visit& visit) const {
    const Branch& here = branches_[branch];
    if (!here.box.intersects(box) || !here.normals.may_oppose(directions)) return;
    if (branch < num_leaves_) {
        visit_against(2 * branch, box, directions, visit);
        visit_against(2 * branch + 1, box, directions, visit);
        return;
    }
    for (std::size_t i = leaf_begin(branch); i < leaf_end(branch); ++i)
        if (boxes_[order_[i]].intersects(box)) visit(order_[i]);
}

}  // namespace incise::contact
