// Where a surface turns sharply within an element: which sheet of it is where, and on which side of
// it elements lie all of whose corners count as on it.
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

/// Whether a surface that passes through an edge at the intersection given as a record of its end
/// is the sheet that left one of the end's snap_history, and not another beyond a crease: it runs
/// in about the same direction, about as far from the end. Of an end without snap_history, it is.
/// @param length  of the edge, m
bool is_same_branch(std::span<const CutRecord> snap_history, const CutRecord& intersection,
                    double length);

/// Whether the straight way from the middle of the tetrahedron to one of its corners crosses the
/// surface. All are as they are after the step.
bool is_crossed_from_middle(const CutSurface& surface, const std::array<MovingPoint, 4>& corners,
                            const MovingPoint& corner);

/// A node that lies on a surface with creases, but for rounding, and not at its boundary.
struct NodeOnSurface {
    NodeId node;
    Vec3 normal;               ///< of the surface there, of unit length
    double local_edge_length;  ///< of its edges that were looked at the longest, m, at rest
};

/// Those of the nodes of some edges. Crossed edges do not tell of them all: where the inside of a
/// crease has no edge of the mesh, the surface crosses none of its node's if rounding has put that
/// outside.
class NodesOnSurface {
  public:
    NodesOnSurface() = default;
    /// @param edges     those of the elements near the surface, in any order
    /// @param rounding  share of the longest edge at a node: as far away it is on the surface
    /// Cost: a search of the surface for each node.
    NodesOnSurface(const CutSurface& surface, const TissueMotion& tissue,
                   std::span<const EdgeList::Entry> edges, double rounding);

    bool is_empty() const { return nodes_.empty(); }
    bool contains(NodeId n) const;
    /// Whether one of the faces of the element has its nodes on the surface.
    bool have_face_of(const topology::Mesh& mesh, ElementId e) const;

    auto begin() const { return nodes_.begin(); }  // in ascending order
    auto end() const { return nodes_.end(); }

  private:
    std::vector<NodeOnSurface> nodes_;
};

}  // namespace incise::cutting
