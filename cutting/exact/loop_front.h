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

/// Holds the nodes through which a cut goes, and the edges and faces that lie on it, where it is
/// not finished.
///
/// Wherever a cut crosses an edge of the mesh it makes a node, or goes *through* the end of the
/// edge if it passes so near to it. In each face at the edge the node *waits* for another node of
/// the cut. When that comes, the cut goes from one to the other: along a new edge that divides the
/// face, which is *marked*, or *along* the edge of the face that they have. That edge is *open* in
/// the two cells at the face. Where open edges of a cell form a closed path, the cut goes through
/// the cell: along a new face that divides it, or along those faces of the cell that lie within the
/// path. The edges of the path are then open no more.
///
/// In each cell a node has an even number of open edges and faces in which it waits: the cut goes
/// into the cell as often as out of it.
class LoopFront {
  public:
    /// Puts a node that the cut has made on it. It waits nowhere yet.
    /// @param local_edge_length  of the edge on which the node was made, at rest, m
    void put_on(VertexId n, double local_edge_length) {
        nodes_.try_emplace(n, Node{local_edge_length, false});
    }
    /// Puts a node on the cut that was there before.
    void put_through(VertexId n, double local_edge_length) {
        nodes_.try_emplace(n, Node{local_edge_length, true});
    }
    bool is_on(VertexId n) const { return nodes_.contains(n); }
    /// True if the node was there before the cut came.
    bool is_through(VertexId n) const {
        const auto it = nodes_.find(n);
        return it != nodes_.end() && it->second.is_through;
    }
    /// True if the node came with another cut, which add() has added.
    bool is_added(VertexId n) const {
        const auto it = nodes_.find(n);
        return it != nodes_.end() && it->second.is_added;
    }
    double local_edge_length(VertexId n) const {
        const auto it = nodes_.find(n);
        return it != nodes_.end() ? it->second.local_edge_length : 0.0;
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
    /// Returns the other ends of the marked edges at a node.
    const std::vector<VertexId>& marked_at(VertexId n) const {
        static const std::vector<VertexId> none;
        const auto it = marked_.find(n);
        return it != marked_.end() ? it->second : none;
    }
    /// Notes that the cut goes along an edge that was there before.
    void set_along(VertexId a, VertexId b) { along_[edge_between(a, b)] = true; }
    /// True if the edge lies on the cut.
    bool lies_on(VertexId a, VertexId b) const {
        return is_marked(a, b) || along_.contains(edge_between(a, b));
    }

    /// An edge at its end `node`, which is on this cut.
    struct EdgeAt {
        VertexId node, end;
    };
    /// Notes that the cut crosses an edge at its end.
    void set_crossed(const EdgeAt& edge) {
        crossed_[edge_between(edge.node, edge.end)] = edge.node;
    }
    /// True if the cut crosses an edge at one of its ends.
    bool is_crossed(VertexId a, VertexId b) const { return crossed_.contains(edge_between(a, b)); }

    /// Returns the end of an edge at which the blade has passed it later, an odd number of times;
    /// an invalid id if it has not. The next time it passes the edge it does so there again,
    /// wherever that is: so a blade that goes back and comes again leaves all as it was.
    VertexId passed_at(VertexId a, VertexId b) const;
    void toggle_passed(const EdgeAt& edge);
    bool has_passed_edges() const { return !passed_.empty(); }

    /// What the cut does in a face.
    struct FaceState {
        bool is_on_cut = false;         ///< true if the face lies on the cut
        bool was_there = false;         ///< true if it did not come with the cut
        std::vector<VertexId> waiting;  ///< the nodes that wait in it
        bool is_empty() const { return !is_on_cut && waiting.empty(); }
        static void archive(auto& ar, auto& self) {
            ar(self.is_on_cut, self.was_there, self.waiting);
        }
    };
    /// Returns the state of a face, which is the same on its two sides.
    const FaceState& state(FaceId f) const;
    bool waits(FaceId f, VertexId n) const {
        const std::vector<VertexId>& waiting = state(f).waiting;
        return std::ranges::find(waiting, n) != waiting.end();
    }
    void set_waiting(const topology::Mesh& mesh, FaceId f, VertexId n, bool waits);
    bool is_cut_face(FaceId f) const { return state(f).is_on_cut; }
    void set_on_cut(const topology::Mesh& mesh, FaceId f, bool is_on_cut, bool was_there);
    /// True if the node waits in the face though an edge of the face that the cut has made goes
    /// there: the blade has passed the node again.
    bool waits_again(const topology::Mesh& mesh, FaceId f, VertexId n) const;
    /// Forgets the state of a face that is to be divided, and returns it.
    FaceState take(const topology::Mesh& mesh, FaceId f);
    /// Gives a part of a face the state of the whole one: its nodes that wait there.
    void put(const topology::Mesh& mesh, FaceId part, const FaceState& whole);

    /// Returns the edges that are open in a cell.
    const std::vector<Edge>& open_edges(CellId e) const {
        static const std::vector<Edge> none;
        const auto it = open_.find(e);
        return it != open_.end() ? it->second : none;
    }
    bool is_open(CellId e, VertexId a, VertexId b) const {
        const std::vector<Edge>& open = open_edges(e);
        return std::ranges::find(open, edge_between(a, b)) != open.end();
    }
    /// Returns the cells with open edges, in ascending order.
    std::vector<CellId> open_cells() const;
    void set_open(CellId e, VertexId a, VertexId b) { open_[e].push_back(edge_between(a, b)); }
    void set_closed(CellId e, VertexId a, VertexId b);

    /// Follows the division of an edge by a new node. The halves of an edge on the cut are on it.
    /// If the edge is open in a cell, its halves are, and the node is on the cut.
    void divide(VertexId a, VertexId b, VertexId middle, double local_edge_length);
    /// Follows the division of a cell. Open edges that it has lost are those of the added part.
    /// @param faces  where the faces are that the cell had, in their order
    void divide(const topology::Mesh& mesh, CellId kept, CellId added,
                std::span<const FaceId> faces);

    /// Follows the blade out of the body, the way it came: passes edges at nodes of the cut, so
    /// that the cut comes into each face as often as it goes out. Another blade may then come.
    void draw_back(const topology::Mesh& mesh);
    /// Adds another cut. Returns false, and changes nothing, if one has made a node of the other.
    bool add(const LoopFront& other);

    /// True if the mesh has all nodes and cells that it names.
    bool is_on(const topology::Mesh& mesh) const;
    /// Forgets everything but the nodes.
    void keep_nodes_only();
    /// Follows an edit: copies of nodes are on the cut as their sources are.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes);
    /// Forgets the nodes round which nothing waits and each path is closed, if they are not at a
    /// cut face of another node. It keeps those without which the cut would not come into each face
    /// as often as it goes out.
    void leave_behind(const topology::Mesh& mesh);

    static void archive(auto& ar, auto& self) {
        ar(self.nodes_, self.marked_, self.along_, self.crossed_, self.passed_, self.faces_,
           self.open_);
    }

  private:
    struct Node {
        double local_edge_length = 0.0;  // m
        bool is_through = false, is_added = false;
        static void archive(auto& ar, auto& self) {
            ar(self.local_edge_length, self.is_through, self.is_added);
        }
    };
    FaceState& state_of(FaceId f) { return faces_[f.cell][f.face]; }
    void forget_if_empty(FaceId f);
    void forget_what_is_off(const topology::Mesh& mesh);

    std::unordered_map<VertexId, Node> nodes_;
    std::unordered_map<VertexId, std::vector<VertexId>> marked_;  // each edge in both directions
    std::map<Edge, bool> along_;
    std::map<Edge, VertexId> crossed_;  // the node at which each is crossed
    std::map<Edge, VertexId> passed_;   // the node at which each is passed
    std::unordered_map<CellId, std::map<std::int32_t, FaceState>> faces_;  // on both sides of each
    std::unordered_map<CellId, std::vector<Edge>> open_;
};

}  // namespace incise::cutting
