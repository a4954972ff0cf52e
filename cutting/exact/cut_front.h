// The state of a cut in progress. Elements at its front are cut in part.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"
#include "incise/topology/mesh_edit.h"

namespace incise::cutting {

/// Holds the nodes that count as on the cut, and the edges at these nodes that the cut crosses.
///
/// A node on the cut stays on its side: an edge from it to another node counts as crossed or not,
/// as any edge does. Two nodes are on different sides of the cut if a path of edges between them,
/// away from the front, has an odd number of intersections. A crossed edge without a node on the
/// cut gets one in the same step.
///
/// A front forgets the nodes round which the cut is finished. A later stroke along the same cut, or
/// across it, is another cut.
class CutFront {
  public:
    /// Makes a node count as on the cut. If it is on the cut already, only its local edge length
    /// can change, and only to more.
    /// @param n                  the node
    /// @param is_exact           true if the node was made on the cut surface; others are near it,
    ///                           on one side
    /// @param local_edge_length  size of the elements there, m
    /// @param rank               see SnapHistory::take_rank()
    void put_on(VertexId n, bool is_exact, double local_edge_length, std::uint64_t rank);
    bool is_on(VertexId n) const { return nodes_.contains(n); }
    bool is_near(VertexId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() && !place->second.is_exact;
    }

    /// Marks a node where the same surface has cut before. What that cut left joined between frozen
    /// nodes stays joined.
    /// @pre  is_on(n)
    void freeze(VertexId n) { nodes_.at(n).is_frozen = true; }
    bool is_frozen(VertexId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() && place->second.is_frozen;
    }

    /// Returns a number that is lower for nodes that came to the cut earlier. It is 0 for nodes
    /// that are not on the cut.
    std::uint64_t rank(VertexId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.rank : 0;
    }

    /// Returns the next twin of a node on the cut. Twins are the nodes that one node has become as
    /// faces of this cut opened; they form a ring. Returns the node itself if it has no twin.
    VertexId next_twin(VertexId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.next_twin : n;
    }

    /// Returns the size of the elements at a node on the cut, m, and 0 for other nodes.
    double local_edge_length(VertexId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.local_edge_length : 0.0;
    }

    bool is_crossed(VertexId a, VertexId b) const;
    void toggle(VertexId a, VertexId b);

    /// The side of an element: whether the path from the element to one of its corners crosses the
    /// cut.
    struct Place {
        VertexId corner;
        bool is_crossed = false;
    };

    /// Returns the side of a tetrahedron, or nothing if it is not known. `corners` are its corners,
    /// or those before a division. These rules apply in turn:
    /// - An element with a corner off the cut is on the side of that corner.
    /// - An element with corners near the cut is on the side of the one that came to the cut last.
    /// - An element with all corners exactly on the cut has the side that place_halves() has kept.
    std::optional<Place> place_of(CellId e, std::span<const VertexId, 4> corners) const;

    /// Keeps the sides of the halves of divided elements, if all their corners are on the cut.
    /// `middle` divides the edge from `a` to `b`. A half without the corner that gave the side of
    /// the whole is on the other side of the cut through the middle.
    /// @pre  the intersections of the new edges are counted
    void place_halves(const topology::Mesh& mesh, VertexId a, VertexId b, VertexId middle,
                      std::span<const topology::MeshEdit::DividedElement> elements);

    /// True if the ids of the nodes on the cut and of the elements exist in the mesh, and twins
    /// form rings. The ends of crossed edges are not checked.
    bool is_on(const topology::Mesh& mesh) const;

    std::size_t size() const { return nodes_.size(); }
    bool is_empty() const { return nodes_.empty(); }

    /// Calls visit(node) for each node on the cut, in no particular order.
    template <class Visit>
    void for_each(Visit visit) const {
        for (const auto& [n, node] : nodes_) visit(n);
    }

    /// Calls visit(node, others) for each node with crossed edges, in no particular order.
    template <class Visit>
    void for_each_crossed(Visit visit) const {
        for (const auto& [n, others] : crossed_) visit(n, others);
    }

    /// Follows an edit. A copy of a node has the state of its source. If the edit has opened faces
    /// of this cut, the copy is also a twin of its source.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes,
               bool has_opened_faces_of_it = false);
    /// Returns the nodes on the cut for which keep(node) is false, in ascending order.
    template <class Keep>
    std::vector<VertexId> nodes_unless(Keep keep) const;
    /// Makes nodes no longer count as on the cut. Forgets which of their edges to nodes off the cut
    /// are crossed, and the sides that were kept of elements at them.
    void forget(const topology::Mesh& mesh, const std::vector<VertexId>& nodes);

    /// Returns how many nodes came to the cut since the last call of set_reviewed().
    std::size_t num_new() const { return num_new_; }
    /// True if anything has changed since the last call of set_reviewed().
    bool has_changed() const { return has_changed_; }
    void set_reviewed() {
        num_new_ = 0;
        has_changed_ = false;
    }

    static void archive(auto& ar, auto& self) {
        ar(self.nodes_, self.crossed_, self.places_, self.num_new_, self.has_changed_);
    }

  private:
    struct Node {
        bool is_exact = false;
        double local_edge_length = 0.0;
        std::uint64_t rank = 0;
        VertexId next_twin;
        bool is_frozen = false;
        static void archive(auto& ar, auto& self) {
            ar(self.is_exact, self.local_edge_length, self.rank, self.next_twin, self.is_frozen);
        }
    };
    struct LocalPlace {
        std::int32_t corner = 0;  // local number; a copy may replace the node there
        bool is_crossed = false;
        static void archive(auto& ar, auto& self) { ar(self.corner, self.is_crossed); }
    };
    std::unordered_map<VertexId, Node> nodes_;
    // By node, the other ends of its crossed edges; each edge is in both directions.
    std::unordered_map<VertexId, std::vector<VertexId>> crossed_;
    // Of elements whose corners are all on the cut.
    std::unordered_map<CellId, LocalPlace> places_;
    std::size_t num_new_ = 0;
    bool has_changed_ = false;
};

template <class Keep>
std::vector<VertexId> CutFront::nodes_unless(Keep keep) const {
    std::vector<VertexId> nodes;
    for (const auto& [n, node] : nodes_)
        if (!keep(n)) nodes.push_back(n);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

}  // namespace incise::cutting
