// The only way to change a mesh: a transaction that ends in a ChangeSet, or leaves no trace.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <unordered_set>
#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Collects operations on a mesh. While it lives nobody else edits the mesh; if it dies without
/// commit(), the mesh is as it was, ids included.
///
/// Nodes are divided once, at commit: wherever the elements round a node no longer hang together
/// through faces at it, the part with the lowest element keeps the node and each other part gets
/// a new one. Removing an element can therefore add nodes, and opening a face need not.
///
/// Cost: proportional to the stars of the nodes that the operations touch.
class MeshEdit {
  public:
    explicit MeshEdit(Mesh& mesh);
    ~MeshEdit();
    MeshEdit(const MeshEdit&) = delete;
    MeshEdit& operator=(const MeshEdit&) = delete;

    /// Removes a living element, not one that this edit has made.
    void remove(ElementId e);
    /// Separates the two elements at a shared face.
    void open(FaceId f);
    /// Joins two boundary faces whose nodes lie at the same rest positions. Nodes that meet become
    /// one, the lower id; the record names the other's source.
    /// Throws InputError if the faces do not fit.
    void close(FaceId a, FaceId b);

    /// An element divided by a new node on one of its edges: `kept` has the first end of the edge
    /// and keeps its id, `added` has the second end. Local numbers of corners stay: in each of them
    /// the new node stands where the other end stood.
    struct DividedElement {
        ElementId kept, added;
    };
    struct Bisection {
        NodeId node;
        std::vector<DividedElement> elements;  ///< the ring round the edge
    };

    /// Divides the edge from `a` to `b` of tetrahedron `e`, and with it every element round the
    /// edge, by a node at (1 - t) a + t b at rest, 0 < t < 1. The mesh stays conforming.
    /// The result is valid until the next call.
    /// Throws InputError if there is no such edge, t is not inside, or a cell at the edge is no
    /// tetrahedron.
    const Bisection& bisect(ElementId e, NodeId a, NodeId b, double t);

    /// Ends the transaction. The mesh's epoch grows by one, unless nothing changed.
    ChangeSet commit();

  private:
    /// One element of the ring round an edge.
    struct RingElement {
        ElementId element;
        int corner_a = 0, corner_b = 0;
        int next_face = 0;  ///< towards the following element of the ring
    };

    struct SavedRow {
        ElementId element;
        bool was_alive;
        std::array<NodeId, max_corners> corners;  // as many as the element has; so below
        std::array<FaceId, max_faces> neighbors;
    };
    struct TouchedCorner {
        NodeId node;
        ElementId element;  // may be dead by now; invalid when only the node is of interest
        auto operator<=>(const TouchedCorner&) const = default;
    };

    void require_alive(ElementId e) const;
    void save(ElementId e);
    void touch_face(FaceId f);
    void part(FaceId f);
    void rewire(ElementId e, int corner, NodeId to);
    bool collect_ring(ElementId e, NodeId a, NodeId b);
    NodeId add_node_between(NodeId a, NodeId b, double t);
    ElementId divide(const RingElement& at, NodeId middle);
    void require_older(ElementId e, const char* what) const;
    void merge(NodeId survivor, NodeId absorbed, ElementId at);
    void divide_nodes(std::vector<NodeRecord>& removed);
    void split_star(NodeId n, const std::vector<ElementId>& candidates,
                    std::vector<NodeRecord>& removed);
    NodeId survivor_of(NodeId n) const;
    ChangeSet differences() const;

    Mesh& mesh_;
    const std::size_t node_capacity_before_, element_capacity_before_;
    bool is_open_ = true;
    std::vector<SavedRow> saved_;
    std::unordered_set<ElementId> is_saved_;
    std::vector<TouchedCorner> touched_;
    std::vector<std::pair<NodeId, NodeId>> merged_;  // absorbed, survivor
    std::vector<NodeRecord> nodes_added_;
    std::vector<ElementId> parents_;  // of the elements added, in their order
    std::vector<RingElement> ring_;   // scratch
    std::vector<ElementId> star_;     // scratch
    Bisection bisection_;
};

/// Applies a recorded edit to a mesh that stands at changes.epoch_before, with the ids recorded.
/// Throws InputError for an edit out of turn.
void replay(Mesh& mesh, const ChangeSet& changes);

}  // namespace incise::topology
