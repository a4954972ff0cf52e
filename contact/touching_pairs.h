// The nodes and triangles of a surface that may touch soon.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/contact/surface_tree.h"
#include "incise/topology/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::contact {

/// Returns the squared distance of a point x to a triangle, m2.
double squared_distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

/// The body that the surface belongs to.
struct ContactBody {
    const topology::Mesh& mesh;
    const topology::FragmentMesh& fragments;
    std::span<const FaceId> faces;             ///< of the mesh, by triangle
    std::span<const std::uint8_t> takes_part;  ///< by triangle, 1: it may touch others
};

/// Pairs of a node and a triangle that are near each other and face each other.
///
/// A node and a triangle face each other if their normals differ by more than a right angle. They
/// do not count if they belong to the same part of the body: fragments at both have common nodes,
/// and they are not the two sides of a cut.
class TouchingPairs {
  public:
    /// Takes note of a new surface.
    void set_surface(const SurfaceTree& tree, const ContactBody& body);
    /// Finds the pairs anew. Cost: O(n) and that of the pairs found.
    /// @param tree   fitted to the positions
    /// @param reach  distance of a node to a triangle that counts as near, m
    void find(const SurfaceTree& tree, const ContactBody& body, std::span<const Vec3> positions,
              double reach);

    /// Returns the nodes with pairs, in ascending order.
    std::span<const NodeId> nodes() const { return nodes_; }
    /// Returns the triangles of the i-th of nodes().
    std::span<const std::uint32_t> triangles_of(std::size_t i) const {
        return {triangles_.data() + begin_[i], begin_[i + 1] - begin_[i]};
    }

  private:
    std::vector<NodeId> surface_nodes_;         // those that take part, in the order of the tree
    std::vector<Vec3> rest_normals_, normals_;  // by node; the latter is scratch
    std::vector<std::uint32_t> near_group_;     // scratch
    std::vector<std::pair<NodeId, std::uint32_t>> found_;  // scratch
    std::vector<NodeId> nodes_;
    std::vector<std::size_t> begin_{0};
    std::vector<std::uint32_t> triangles_;
};

}  // namespace incise::contact
