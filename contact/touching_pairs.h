// The nodes and triangles of a surface that may touch soon.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/contact/surface_tree.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::contact {

/// Returns the squared distance of a point x to a triangle, m2.
double squared_distance(const Vec3& x, const Vec3& a, const Vec3& b, const Vec3& c);

/// A node, and the number of a triangle of the surface.
using NodeAndTriangle = std::pair<VertexId, std::uint32_t>;

/// The body that the surface belongs to.
struct ContactBody {
    const topology::Mesh& mesh;
    const fragments::FragmentMesh& fragments;
    std::span<const FaceId> faces;             ///< of the mesh, by triangle
    std::span<const std::uint8_t> takes_part;  ///< by triangle, 1: it may touch others
};

/// Appends the corners of all fragments with a cell at a node. Some may come several times.
/// @param star  scratch
void append_fragment_corners(const ContactBody& body, VertexId n, std::vector<CellId>& star,
                             std::vector<NodeId>& corners);

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
    /// @param tree      fitted to the positions
    /// @param reach     distance of a node to a triangle that counts as near, m
    /// @param touching  pairs that touch: they count as near, however deep they overlap
    void find(const SurfaceTree& tree, const ContactBody& body, std::span<const Vec3> positions,
              double reach, std::span<const NodeAndTriangle> touching);

    /// Finds the pairs of some nodes anew, and keeps those of the others.
    /// @param number_of_old  by triangle of the last surface, its number in the tree; -1 if it is
    ///                       gone. Nodes with a triangle that is gone count as chosen.
    /// @param is_chosen      is_chosen(n): find the pairs of this node. It is called once for each
    ///                       node of the surface.
    void find_again(const SurfaceTree& tree, const ContactBody& body,
                    std::span<const Vec3> positions, double reach,
                    std::span<const std::int32_t> number_of_old,
                    const std::function<bool(VertexId)>& is_chosen,
                    std::span<const NodeAndTriangle> touching);

    /// The part of a surface that has moved by more than the rest.
    struct MovedPart {
        std::span<const std::uint8_t> is_triangle;  ///< by triangle, 1: it belongs to the part
        std::span<const std::uint8_t> is_node;      ///< likewise, by vertex id
        std::span<const std::uint8_t> is_near;      ///< by vertex id, 1: it may be near the part
    };
    /// Finds anew the pairs with a part of the surface, and keeps the others. Cost: O(n) and that
    /// of the pairs with the part.
    void find_moved(const SurfaceTree& tree, const ContactBody& body,
                    std::span<const Vec3> positions, double reach, const MovedPart& moved,
                    std::span<const NodeAndTriangle> touching);

    /// Returns the nodes with pairs, in ascending order.
    std::span<const VertexId> nodes() const { return nodes_; }
    /// Returns how many nodes and triangles were compared so far: the cost of the searches.
    std::size_t num_tested() const { return num_tested_; }
    /// Returns the number of pairs.
    std::size_t size() const { return triangles_.size(); }
    /// Returns the triangles of the i-th of nodes().
    std::span<const std::uint32_t> triangles_of(std::size_t i) const {
        return {triangles_.data() + begin_[i], begin_[i + 1] - begin_[i]};
    }

    static void archive(auto& ar, auto& self) { ar(self.nodes_, self.begin_, self.triangles_); }
    /// True if the pairs can be those of a surface with so many triangles.
    bool fits(std::size_t num_nodes, std::size_t num_triangles) const;

  private:
    /// @param is_triangle  by triangle, 1: it counts; empty: all count
    void append_pairs(const SurfaceTree& tree, const ContactBody& body,
                      std::span<const Vec3> positions, double reach,
                      std::span<const VertexId> nodes, std::span<const std::uint8_t> is_triangle);
    /// @param num_sorted  pairs that are in order already, at the beginning
    void take_found(std::size_t num_sorted, std::span<const NodeAndTriangle> touching);
    /// Returns the corners of all fragments at a node of the surface, in ascending order. They are
    /// listed when they are asked for, and known until the surface is another one.
    std::span<const NodeId> around(const ContactBody& body, VertexId n);
    /// True if a node and a triangle with common fragments are the two sides of a cut.
    bool are_sides_of_cut(const SurfaceTree& tree, const ContactBody& body, VertexId n,
                          std::uint32_t t) const;

    static constexpr std::size_t none_yet = std::numeric_limits<std::size_t>::max();
    std::vector<VertexId> surface_nodes_;       // those that take part, in the order of the tree
    std::vector<Vec3> rest_normals_, normals_;  // by node; the latter is scratch
    std::vector<std::size_t> around_begin_;     // by node, of its list in around_, or none_yet
    std::vector<NodeId> around_;                // lists, each with its length before it
    std::vector<std::uint8_t> is_around_;       // scratch, by node of the fragments
    std::vector<NodeId> corners_;               // scratch
    std::vector<CellId> star_;                  // scratch
    std::vector<std::uint32_t> near_group_, near_node_;  // scratch
    std::vector<NodeAndTriangle> found_;                 // scratch
    std::vector<VertexId> moved_nodes_, near_moved_;     // scratch of find_moved()
    std::size_t num_tested_ = 0;
    std::vector<VertexId> nodes_;
    std::vector<std::size_t> begin_{0};
    std::vector<std::uint32_t> triangles_;
};

}  // namespace incise::contact
