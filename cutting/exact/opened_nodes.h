// Nodes on faces that cuts have opened, which count as lying inside the body by a margin.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/split.h"
#include "incise/topology/change_set.h"
#include "incise/topology/field.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Knows the nodes that lie on opened faces, and moves them into the body by the tolerance of a cut
/// in the eyes of later cuts. So a blade that comes again to such a face, at the same place to the
/// tolerance, finds all of the body on one side of it.
///
/// While a cut is in progress, a node goes in along the mean normal of its faces. When all cuts are
/// over, the nodes are *settled*: then a node, also one beside the faces by less than the
/// tolerance, goes inside each of the planes of opened faces near it. Where planes meet, this is
/// where the body with its faces moved inwards has its edges and corners.
class OpenedNodes {
  public:
    using Positions = topology::NodeField<VertexId, Vec3>;

    /// Finds all opened faces of a body. Their cuts are taken to have had the default tolerance.
    /// Cost: proportional to its cuts.
    /// @param usual  the size of its cells, m
    void find_all(const topology::Mesh& mesh, double usual);

    /// Follows an edit of the mesh. Nodes that are new here are not moved before the next
    /// move_all() or move_new(). Cost: proportional to the edit.
    /// @param snap  tolerance of the cut that has made the edit: see SplitOptions
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes, double snap);

    /// Settles nodes that edits have touched.
    /// @param most  so many of them at most
    /// @pre  no cut is in progress
    /// Cost: some ten microseconds a node.
    void settle(const topology::Mesh& mesh, std::size_t most);

    /// Returns by how much a node is moved, m; nothing if it was moved at the last time, and is to
    /// be moved no more.
    std::optional<Vec3> offset_of(VertexId n) const {
        if (const auto node = nodes_.find(n); node != nodes_.end()) return node->second.offset;
        if (std::ranges::binary_search(forgotten_, n)) return std::nullopt;
        return Vec3::Zero();
    }
    /// Moves all nodes in `seen`, by vertex id.
    /// @param positions  where the nodes are, m
    void move_all(std::span<const Vec3> positions, Positions& seen);
    /// Moves those nodes that are not where they should be. Returns how far they go at most, m.
    double move_new(Positions& seen);
    /// True if some nodes are not where they should be.
    bool has_new() const;

    /// Returns the size of the cells of the body, m.
    double usual() const { return usual_; }

    /// True if the mesh has all nodes that it names.
    bool is_on(const topology::Mesh& mesh) const;
    static void archive(auto& ar, auto& self) {
        ar(self.usual_, self.nodes_, self.unsettled_, self.forgotten_, self.snaps_);
    }

  private:
    /// Corners of an opened face, anticlockwise as seen from outside.
    using Plane = std::array<VertexId, 3>;
    struct Node {
        double margin = 0.0;         // m
        Vec3 offset = Vec3::Zero();  // by which it is moved in the present positions, m
        bool is_moved = false;       // true if by as much as it should be
        std::vector<std::pair<VertexId, VertexId>> around;  // its neighbours round the faces
        std::vector<Plane> planes;                          // of a node that is settled
        static void archive(auto& ar, auto& self) {
            ar(self.margin, self.offset, self.is_moved, self.around, self.planes);
        }
    };

    void find_at(const topology::Mesh& mesh, std::vector<VertexId> nodes);
    double snap_of(VertexId n) const {
        const auto snap = snaps_.find(n);
        return snap != snaps_.end() ? snap->second : default_snap;
    }
    void note_snap(VertexId n, double snap);
    void forget(VertexId n, const Node& node);
    static void move(VertexId n, Node& node, std::span<const Vec3> positions, Positions& seen);

    double usual_ = 0.0;  // size of cells, m
    std::unordered_map<VertexId, Node> nodes_;
    std::vector<VertexId> unsettled_;  // on or beside opened faces
    std::vector<VertexId> forgotten_;  // that were moved at the last time, in ascending order
    std::unordered_map<VertexId, double> snaps_;  // of nodes on opened faces, unless the default
};

}  // namespace incise::cutting
