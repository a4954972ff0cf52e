// The state of a cut in progress through cells of any shape.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/edge_list.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Holds the nodes that a cut has made, and the edges that lie on it, where it is not finished.
///
/// A cut makes a node wherever it crosses an edge of the mesh. In each face at the edge the node
/// *waits* for another node of the cut. When that comes, an edge between the two divides the face:
/// it is *marked*, as it lies on the cut, and it is *open* in the two cells at the face. Where open
/// edges of a cell form a closed path, a face along the path divides the cell, and they are open no
/// more. All edges of such a face are marked.
///
/// A node waits in a face if neither of its two edges of the face is marked. Some corners of faces
/// are *switched*: there it is the other way round. A face that another cut divides has such
/// corners, as the cut enters one of its parts only. So has a face that the cut is to cross again
/// beside one of its own edges.
///
/// In each cell a node has an even number of open edges and corners at which it waits: the cut
/// goes into the cell as often as out of it.
class LoopFront {
  public:
    /// @param local_edge_length  of the edge on which the node was made, at rest, m
    void put_on(VertexId n, double local_edge_length) { nodes_.try_emplace(n, local_edge_length); }
    bool is_on(VertexId n) const { return nodes_.contains(n); }
    double local_edge_length(VertexId n) const {
        const auto it = nodes_.find(n);
        return it != nodes_.end() ? it->second : 0.0;
    }
    /// Passes each node that is on the cut, in no particular order.
    template <class Visit>
    void for_each(Visit visit) const {
        for (const auto& entry : nodes_) visit(entry.first);
    }
    bool is_empty() const { return nodes_.empty(); }
    std::size_t size() const { return nodes_.size(); }

    bool is_marked(VertexId a, VertexId b) const {
        const auto it = marked_.find(a);
        return it != marked_.end() && std::ranges::find(it->second, b) != it->second.end();
    }
    void mark(VertexId a, VertexId b);
    /// Follows the division of an edge by a new node. The halves of a marked edge are marked. If
    /// the edge is open in a cell, its halves are, and the node is on the cut.
    void divide(VertexId a, VertexId b, VertexId middle, double local_edge_length);
    /// Returns the other ends of the marked edges at a node.
    const std::vector<VertexId>& marked_at(VertexId n) const {
        static const std::vector<VertexId> none;
        const auto it = marked_.find(n);
        return it != marked_.end() ? it->second : none;
    }

    /// An edge that the blade has passed at its end `node`, which is on this cut, an odd number of
    /// times. The next time it passes the edge it does so at this node again, wherever that is: so
    /// a blade that goes back and comes again leaves all as it was.
    struct PassedEdge {
        VertexId node, end;
    };
    /// Returns the node at which the blade has passed an edge; an invalid id if at none.
    VertexId passed_at(VertexId a, VertexId b) const;
    void toggle_passed(const PassedEdge& edge);
    bool has_passed_edges() const { return !passed_.empty(); }

    /// A node of a face, between its neighbours round the face.
    struct Corner {
        VertexId node, previous, next;
    };
    static Corner corner(const topology::Mesh& mesh, FaceId f, VertexId n);
    /// Says whether the node waits at a corner.
    void set_waiting(const Corner& corner, bool waits);
    /// Follows the division of a face by an edge from a node of it to another one. The node waits
    /// in both parts as it did in the face.
    void divide(const Corner& corner, VertexId end);

    bool waits(const Corner& corner) const;
    /// True if an edge of the corner is marked.
    bool is_joined(const Corner& corner) const {
        return is_marked(corner.node, corner.previous) || is_marked(corner.node, corner.next);
    }
    /// True if the node waits in the face: see above. @pre  it is a corner of the face
    bool waits(const topology::Mesh& mesh, FaceId f, VertexId n) const;
    /// True if all edges of the face are marked.
    bool is_cut_face(const topology::Mesh& mesh, FaceId f) const;
    /// Returns the edges that are open in a cell.
    const std::vector<Edge>& open_edges(CellId e) const {
        static const std::vector<Edge> none;
        const auto it = open_.find(e);
        return it != open_.end() ? it->second : none;
    }
    /// Returns the cells with open edges, in ascending order.
    std::vector<CellId> open_cells() const;
    void set_open(CellId e, VertexId a, VertexId b) { open_[e].push_back(edge_between(a, b)); }
    void set_closed(CellId e, VertexId a, VertexId b);
    /// Follows the division of a cell: open edges that it has lost are those of the added part.
    void divide(const topology::Mesh& mesh, CellId kept, CellId added);

    /// Follows the blade out of the body, the way it came: passes edges at nodes of the cut, so
    /// that the cut comes into each face as often as it goes out. Another blade may then come.
    void draw_back(const topology::Mesh& mesh);
    /// Adds another cut, with no common nodes. Returns false, and changes nothing, if there are.
    bool add(const topology::Mesh& mesh, const LoopFront& other);

    /// True if the mesh has all nodes and cells that it names.
    bool is_on(const topology::Mesh& mesh) const;
    /// Forgets everything but the nodes.
    void keep_nodes_only() {
        marked_.clear();
        switched_.clear();
        open_.clear();
        passed_.clear();
    }
    /// Follows an edit: copies of nodes are on the cut as their sources are.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);
    /// Forgets the cut at some nodes.
    void forget(std::span<const VertexId> nodes);
    /// Forgets the nodes round which nothing waits and each path is closed, if they are not at a
    /// cut face of another node. It keeps those without which the cut would not come into each face
    /// as often as it goes out.
    void leave_behind(const topology::Mesh& mesh);

    static void archive(auto& ar, auto& self) {
        ar(self.nodes_, self.marked_, self.switched_, self.open_, self.passed_);
    }

  private:
    bool is_switched(const Corner& corner) const;
    void forget(VertexId n);

    std::unordered_map<VertexId, double> nodes_;                  // their local edge lengths, m
    std::unordered_map<VertexId, std::vector<VertexId>> marked_;  // each edge in both directions
    std::unordered_map<VertexId, std::vector<Edge>> switched_;    // the neighbours at the corners
    std::unordered_map<CellId, std::vector<Edge>> open_;
    std::map<Edge, VertexId> passed_;  // the node at which each is passed
};

}  // namespace incise::cutting
