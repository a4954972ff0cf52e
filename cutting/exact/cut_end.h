// The end of a cut at the edge of a blade that has stopped, within the elements that it divides.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "incise/cutting/exact/blade_end.h"
#include "incise/cutting/exact/edge_intersections.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/cutting/exact/surface_boundary.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

/// Holds the nodes at the blade's edge where a cut ends, and decides which faces open there. The
/// elements have been divided along the continuation of the blade's path. Of the faces on the
/// continuation, those behind the blade's edge open. Faces that the edge passes through are divided
/// at the edge.
///
/// A carrier that is cut in part moves as if it were whole. So in a carrier through whose section
/// the blade has passed by half or more, the faces ahead of the edge open, too.
/// @lifetime  mesh, fragments and blade must outlive the object
class CutEnd {
  public:
    /// @param mesh       during the edit
    /// @param fragments  before the edit
    CutEnd(const topology::Mesh& mesh, const fragments::FragmentMesh& fragments,
           const BladeEnd& blade, PositionOf position)
        : mesh_(mesh), fragments_(fragments), blade_(blade), position_(std::move(position)) {}

    /// Follows the division of elements.
    void follow(std::span<const topology::MeshEdit::DividedElement> elements) {
        for (const auto& [kept, added] : elements) new_carriers_[added] = carrier_of(kept);
    }

    /// An edge of a face with one end behind the blade's edge and the other ahead of it.
    struct CrossedEdge {
        Edge edge;
        CellId element;                 ///< one of those that have the edge
        EdgeIntersection intersection;  ///< with the blade's edge
    };
    /// Returns the edges that the blade's edge crosses, each once. Near ends of these edges count
    /// as at the blade's edge from now on.
    /// @param faces  on the cut
    /// @param share  of a crossed edge: its nearer end is near if it is nearer than this
    std::vector<CrossedEdge> crossed_edges(std::span<const FaceId> faces, double share);

    /// Makes the node count as at the blade's edge.
    void put_at(VertexId n) { nodes_.insert(n); }
    bool is_at(VertexId n) const { return nodes_.contains(n); }

    /// Returns which faces on the cut and on its continuation open, in their order.
    /// @param faces  between the two sides, joined
    /// @pre  edges that cross the blade's edge have been divided there
    std::vector<FaceId> faces_to_open(std::span<const FaceId> faces) const;

  private:
    bool is_behind(FaceId f) const;
    bool is_ahead_inside(FaceId f) const;
    CarrierId carrier_of(CellId e) const {
        const auto known = new_carriers_.find(e);
        return known != new_carriers_.end() ? known->second : fragments_.carrier_of_cell(e);
    }
    std::optional<EdgeIntersection> intersection(const Edge& edge) const;
    double distance_ahead(VertexId n) const { return blade_.distance_ahead(position_(n)); }

    const topology::Mesh& mesh_;
    const fragments::FragmentMesh& fragments_;
    const BladeEnd& blade_;
    PositionOf position_;
    std::unordered_map<CellId, CarrierId> new_carriers_;  // of elements that the edit has made
    std::unordered_set<VertexId> nodes_;                  // that count as at the blade's edge
};

}  // namespace incise::cutting
