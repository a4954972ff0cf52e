// Where a cut ends within the elements that it divides: at the edge of a blade that has stopped.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/surface_boundary.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// The elements at the end of a way have been divided along its continuation. Of the faces on it
/// those behind the blade's edge are to open. Where they run on ahead they are divided at the edge.
class CutEnd {
  public:
    CutEnd(const topology::Mesh& mesh, const BladeEnd& blade, PositionOf position)
        : mesh_(mesh), blade_(blade), position_(std::move(position)) {}

    /// An edge of a face, from behind the blade's edge to ahead of it, and where it crosses that.
    struct CrossedEdge {
        Edge edge;
        ElementId element;  ///< one of those that have it
        EdgeIntersection intersection;
    };
    /// Of faces on the cut, each once. Nodes nearer to the blade's edge than a share of an edge
    /// that crosses it, and than `farthest`, m at rest, count as at the blade's edge from now on.
    std::vector<CrossedEdge> crossed_edges(std::span<const FaceId> faces, double share,
                                           double farthest);

    /// The node counts as at the blade's edge.
    void put_at(NodeId n) { nodes_.insert(n); }
    bool is_at(NodeId n) const { return nodes_.contains(n); }

    /// Whether no part of a face on the cut is ahead of the blade's edge, once what crosses that is
    /// divided there.
    bool is_behind(FaceId f) const;

  private:
    std::optional<EdgeIntersection> intersection(const Edge& edge) const;
    double distance_ahead(NodeId n) const { return blade_.distance_ahead(position_(n)); }

    const topology::Mesh& mesh_;
    const BladeEnd& blade_;
    PositionOf position_;
    std::unordered_set<NodeId> nodes_;  // at the blade's edge
};

/// The same blade, if its cut is behind it, else one that goes on away from its cut: a blade may
/// also cut because the tissue moves.
BladeEnd away_from_cut(const BladeEnd& blade, const topology::Mesh& mesh, const CutFront& front,
                       const PositionOf& position);

/// How far the edge has to go on to be past all of the elements that it is in, m; 0 if it is in
/// none. An edge in a face between two is in one of them (space_time.h).
double exit_distance(const TissueMotion& tissue, const BladeEnd& blade);

}  // namespace incise::cutting
