// Decides which ends of crossed edges are so near to a surface that they count as on it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An end of a crossed edge, with the intersection as seen from there.
struct EdgeEnd {
    NodeId node, other;
    ElementId element;   ///< one of those that have the edge
    double place, from;  ///< as in EdgeIntersection, from this end
};

/// How near to the surface a node must be to count as on it.
struct NearLimits {
    double share;     ///< of an edge of the node that the surface crosses
    double farthest;  ///< m, at rest
};

/// A search for the nodes of a mesh that are near a surface.
/// @pre  between calls, the mesh changes only by the division of edges
class NearNodes {
  public:
    NearNodes(const topology::Mesh& mesh, const NearLimits& limits)
        : mesh_(mesh), limits_(limits) {}

    /// True if the end counts as on the surface.
    ///
    /// A node counts for all of its edges at once, from the first edge on to which the surface
    /// comes. So edges that the surface will cross if it goes straight on count as crossed. Then
    /// the result does not depend on the number of steps of a blade.
    ///
    /// Both ends of an edge that lies nearly in the surface may be near. Such an edge lets only its
    /// nearer end count. Otherwise whole layers of elements would lie on the surface.
    /// @param end             the end of an edge
    /// @param normal_at_rest  of the surface, of unit length; if zero, it is not known, and only
    ///                        this edge counts
    /// Cost: that of visiting the elements at the node, if its longest edge is long enough to
    /// matter.
    bool has(const EdgeEnd& end, const Vec3& normal_at_rest);

  private:
    void collect_star(const EdgeEnd& end);
    double longest_edge_once(const EdgeEnd& end);

    const topology::Mesh& mesh_;
    const NearLimits limits_;
    /// By node id: the longest edge, m, at the first call for the node. Divisions make no edge of a
    /// node longer, since a new edge lies within a triangle that has two of them.
    std::unordered_map<NodeId, double> longest_edges_;
    std::vector<ElementId> star_;  // scratch
};

}  // namespace incise::cutting
