// Creases, where a surface turns sharply within an element. Decides which branch of the surface
// passes through an edge, and the side of elements whose corners all count as on the surface.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <vector>

#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// True if an intersection with an edge is on the same branch of the surface as a record of the
/// edge's end, and not on another branch beyond a crease. The normals must agree to 18 degrees, and
/// the distances from the end to a fifth of the edge. True if the end has no records.
/// @param snap_history  the records of the end
/// @param intersection  the intersection, as a record of the same end
/// @param length        of the edge, m
bool is_same_branch(std::span<const CutRecord> snap_history, const CutRecord& intersection,
                    double length);

/// True if the straight path from the middle of a tetrahedron to one of its corners crosses the
/// surface an odd number of times. Positions are those after the step.
bool is_crossed_from_middle(const CutSurface& surface, const std::array<MovingPoint, 4>& corners,
                            const MovingPoint& corner);

/// A node that lies on a surface with creases to rounding, and not on its boundary.
struct NodeOnSurface {
    VertexId node;
    Vec3 normal;               ///< of the surface there, of unit length
    double local_edge_length;  ///< of its longest edge among those given, m at rest
};

/// The nodes of some edges that lie on a surface with creases. Crossed edges do not show all of
/// them. At a crease without an edge of the mesh on its inner side, rounding may put the node on
/// the outer side. The surface then crosses none of the edges of the node.
class NodesOnSurface {
  public:
    NodesOnSurface() = default;
    /// Finds the nodes. There are none if the surface has no creases.
    /// @param surface   where the nodes lie
    /// @param tissue    positions after the step are used
    /// @param edges     of the elements near the surface, in any order
    /// @param rounding  share of the longest edge at a node, up to which the node is on the surface
    /// Cost: a search of the surface for each node.
    NodesOnSurface(const CutSurface& surface, const TissueMotion& tissue,
                   std::span<const EdgeList::Entry> edges, double rounding);

    bool is_empty() const { return nodes_.empty(); }
    bool contains(VertexId n) const;
    /// True if the element is a tetrahedron and one of its faces has all its nodes on the surface.
    bool have_face_of(const topology::Mesh& mesh, CellId e) const;

    auto begin() const { return nodes_.begin(); }  // in ascending order
    auto end() const { return nodes_.end(); }

  private:
    std::vector<NodeOnSurface> nodes_;
};

}  // namespace incise::cutting
