// What a cut that goes on has to remember: the elements at its front are cut in part.
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

/// The nodes that count as lying on the cut, and which edges at them the cut passes through.
///
/// A node on the cut stays on the side where it happens to be: an edge between it and another node
/// counts as crossed or not, like any edge. Two nodes are on different sides of the cut if a path
/// of edges between them, away from the front, crosses it an odd number of times. Edges without a
/// node on the cut are never crossed for long: they get one.
///
/// A front forgets what it has left behind, so that a later stroke along the same cut, or across
/// it, stands for itself.
class CutFront {
  public:
    /// Of the cut, from SnapHistory::take_rank: higher than those of earlier cuts; 0 before it
    /// begins.
    std::uint64_t number() const { return number_; }
    void set_number(std::uint64_t number) { number_ = number; }

    /// Counts the node as on the cut. A node made on the cut lies there exactly; others are near
    /// it, on one side. `local_edge_length` is the size of the elements there, m; `rank`, see
    /// SnapHistory::take_rank. Of a node that is on the cut already only the local_edge_length can
    /// change, to more.
    void put_on(NodeId n, bool is_exact, double local_edge_length, std::uint64_t rank);
    bool is_on(NodeId n) const { return nodes_.contains(n); }
    bool is_near(NodeId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() && !place->second.is_exact;
    }

    /// The same surface has cut here before: what it left joined between such nodes stays so.
    void freeze(NodeId n) { nodes_.at(n).is_frozen = true; }
    bool is_frozen(NodeId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() && place->second.is_frozen;
    }

    /// Lower for nodes that came to the cut before others; 0 for those that are not on it.
    std::uint64_t rank(NodeId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.rank : 0;
    }

    /// The next of the nodes that a node on the cut has become by the faces of this cut that have
    /// opened since it came to it: from one to the next they make a ring. The node itself if it is
    /// the only one.
    NodeId next_twin(NodeId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.next_twin : n;
    }

    /// Size of the elements at a node on the cut, m; 0 for others.
    double local_edge_length(NodeId n) const {
        const auto place = nodes_.find(n);
        return place != nodes_.end() ? place->second.local_edge_length : 0.0;
    }

    bool is_crossed(NodeId a, NodeId b) const;
    void toggle(NodeId a, NodeId b);

    /// Where an element is: whether the way from there to one of its corners crosses the cut.
    struct Place {
        NodeId corner;
        bool is_crossed = false;
    };

    /// Of a tetrahedron, or of one that was divided, with the corners that it had. An element is
    /// where its corner is that is not on the cut. One that has no such corner is where it was
    /// made; if it had one then, where the last of its corners is that came to count as on the cut,
    /// being near it. Nothing if all were made on the cut and it is not known.
    std::optional<Place> place_of(ElementId e, std::span<const NodeId, 4> corners) const;

    /// Keeps where the halves of elements are that were divided by `middle`, between `a` and `b`,
    /// once the crossings of its edges are counted: a half that has lost the corner which told is
    /// on the other side of the cut through the middle.
    void place_halves(const topology::Mesh& mesh, NodeId a, NodeId b, NodeId middle,
                      std::span<const topology::MeshEdit::DividedElement> elements);

    /// Whether the mesh has had all nodes and elements of it, and twins make rings.
    bool is_on(const topology::Mesh& mesh) const;

    /// Elements of small pieces that are not to come off before it is known whether they hang on
    /// the rest of their side.
    const std::vector<ElementId>& waiting() const { return waiting_; }
    void set_waiting(std::vector<ElementId> elements) { waiting_ = std::move(elements); }

    std::size_t size() const { return nodes_.size(); }
    bool is_empty() const { return nodes_.empty(); }

    /// Calls visit(node) for each node on the cut, in no order.
    template <class Visit>
    void for_each(Visit visit) const {
        for (const auto& [n, node] : nodes_) visit(n);
    }

    /// Calls visit(node, others) for each node with crossed edges, in no order.
    template <class Visit>
    void for_each_crossed(Visit visit) const {
        for (const auto& [n, others] : crossed_) visit(n, others);
    }

    /// Copies of a node are what it is, and its twins if the edit has opened faces of this cut.
    void apply(const topology::Mesh& mesh, const topology::ChangeSet& changes,
               bool has_opened_faces_of_it = false);
    /// The nodes for which keep(node) is false, in ascending order.
    template <class Keep>
    std::vector<NodeId> nodes_unless(Keep keep) const;
    /// Forgets that they are on the cut, which edges to nodes off it are crossed, and where
    /// elements at them are.
    void forget(const topology::Mesh& mesh, const std::vector<NodeId>& nodes);

    /// Of the nodes on the cut, how many are so since the last call of set_reviewed(); whether
    /// anything has changed since.
    std::size_t num_new() const { return num_new_; }
    bool has_changed() const { return has_changed_; }
    void set_reviewed() {
        num_new_ = 0;
        has_changed_ = false;
    }

    static void archive(auto& ar, auto& self) {
        ar(self.number_, self.nodes_, self.crossed_, self.places_, self.waiting_, self.num_new_,
           self.has_changed_);
    }

  private:
    struct Node {
        bool is_exact = false;
        double local_edge_length = 0.0;
        std::uint64_t rank = 0;
        NodeId next_twin;
        bool is_frozen = false;
        static void archive(auto& ar, auto& self) {
            ar(self.is_exact, self.local_edge_length, self.rank, self.next_twin, self.is_frozen);
        }
    };
    struct LocalPlace {
        std::int32_t corner = 0;  // which of the element's: copies of nodes take its place
        bool is_crossed = false;
        static void archive(auto& ar, auto& self) { ar(self.corner, self.is_crossed); }
    };
    std::uint64_t number_ = 0;
    std::unordered_map<NodeId, Node> nodes_;
    // Both directions of each crossed edge.
    std::unordered_map<NodeId, std::vector<NodeId>> crossed_;
    // Of elements whose corners are all on the cut.
    std::unordered_map<ElementId, LocalPlace> places_;
    std::vector<ElementId> waiting_;
    std::size_t num_new_ = 0;
    bool has_changed_ = false;
};

template <class Keep>
std::vector<NodeId> CutFront::nodes_unless(Keep keep) const {
    std::vector<NodeId> nodes;
    for (const auto& [n, node] : nodes_)
        if (!keep(n)) nodes.push_back(n);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

}  // namespace incise::cutting
