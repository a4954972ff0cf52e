// Which ends of crossed edges are so near a surface that they count as on it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "incise/topology/mesh.h"

namespace incise::cutting {

/// An end of an edge that the surface passes through, and where, seen from there.
struct EdgeEnd {
    NodeId node, other;
    ElementId element;   ///< one of those that have the edge
    double place, from;  ///< as in EdgeIntersection
};

/// How near a node has to be to count as on the surface.
struct NearLimits {
    double share;     ///< of an edge at the node that the surface passes through
    double farthest;  ///< m, at rest
};

/// Of a mesh of which edges are divided meanwhile, but nothing else is changed.
class NearNodes {
  public:
    NearNodes(const topology::Mesh& mesh, const NearLimits& limits)
        : mesh_(mesh), limits_(limits) {}

    /// Whether the end is so near that it counts as on the surface. It is that for all of its
    /// edges at once, from the first of them on that the surface comes to: so those of them count
    /// that the surface passes through if it goes on straight, and it does not matter into how many
    /// steps the way of a blade is taken. Of an edge that lies all but in the surface both ends
    /// might be near; that edge speaks for the nearer one only, or whole layers of elements would
    /// lie on the surface.
    /// @param normal_at_rest  of the surface, of unit length, or zero if not known: only the edge
    ///                        counts then
    /// Cost: a look at the elements round the node, if its longest edge is long enough to matter.
    bool has(const EdgeEnd& end, const Vec3& normal_at_rest);

  private:
    void collect_star(const EdgeEnd& end);
    double longest_edge_once(const EdgeEnd& end);

    const topology::Mesh& mesh_;
    const NearLimits limits_;
    /// By node id, m, when the node was first asked for. Divisions make no edge at a node longer:
    /// a new one lies within a triangle that has two of them.
    std::unordered_map<NodeId, double> longest_edges_;
    std::vector<ElementId> star_;  // scratch
};

}  // namespace incise::cutting
