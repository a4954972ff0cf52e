// Edits of a mesh: transactions that end in a ChangeSet, or leave the mesh unchanged.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>
#include <unordered_set>
#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/darts.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// A transaction of operations on a mesh. If it is destroyed without commit(), the mesh is as it
/// was before, including all ids.
///
/// Nodes are divided once, at commit(). A node is divided if its elements are no longer connected
/// through faces at the node. The part with the lowest element keeps the node, and each other part
/// gets a new node. Removing an element can therefore add nodes, and opening a face may add none.
///
/// Cost: proportional to the number of elements at the nodes that the operations touch.
/// @pre  nothing else edits the mesh while the MeshEdit exists
class MeshEdit {
  public:
    explicit MeshEdit(Mesh& mesh);
    ~MeshEdit();
    MeshEdit(const MeshEdit&) = delete;
    MeshEdit& operator=(const MeshEdit&) = delete;

    /// Removes a living element. Throws InputError if there is no such element, or if this edit has
    /// added it.
    void remove(CellId e);
    /// Separates the two elements at a shared face. Throws InputError if the face is on the
    /// boundary.
    void open(FaceId f);
    /// Joins two boundary faces whose nodes lie at the same rest positions. Two nodes that meet are
    /// merged into the node with the lower id, which the record names as the source of the other.
    /// Throws InputError if the faces do not fit.
    void close(FaceId a, FaceId b);

    /// An element that was divided by a new node on one of its edges. `kept` has the first end of
    /// the edge and keeps its id; `added` has the second end. Local corner numbers do not change:
    /// in each part the new node replaces the end of the edge that the part does not have.
    struct DividedElement {
        CellId kept, added;
    };
    /// The result of bisect().
    struct Bisection {
        VertexId node;
        std::vector<DividedElement> elements;  ///< all elements at the edge
    };

    /// Divides the edge from `a` to `b` of tetrahedron `e`, and with it every element at the edge.
    /// The new node is at (1 - t) a + t b at rest, 0 < t < 1. The mesh stays conforming.
    /// The returned reference is valid until the next call.
    /// Throws InputError if there is no such edge, if `t` is out of range, or if an element at the
    /// edge is no tetrahedron.
    const Bisection& bisect(CellId e, VertexId a, VertexId b, double t);

    // The operations of Euler on cells of any kind. A cell that one of them changes becomes a
    // polyhedron. They need no inverses: those of the record are exact. All throw InputError if the
    // cell is dead, or if bisect() has made it in this edit.
    // Source: Damiand, Lienhardt 2014, Combinatorial Maps, chapter 6.

    /// Divides an edge, in all cells at it, by a new node at (1 - t) a + t b at rest, 0 < t < 1,
    /// where the dart goes from a to b. Returns the node.
    VertexId divide_edge(const Dart& d, double t);
    /// The same for an edge from a to b.
    /// @param cells  all cells at the edge; see append_cells_at_edge()
    VertexId divide_edge(std::span<const CellId> cells, VertexId a, VertexId b, double t);
    /// Divides a face, on both sides, by a new edge between two of its corners. The part from
    /// `a` on to `b`, in the direction of the face, keeps the number of the face, and so does its
    /// other side. Returns the other part.
    /// @pre  the corners have no edge in a cell at the face
    FaceId divide_face(FaceId f, VertexId a, VertexId b);
    /// Divides a face likewise by two new edges, from `a` by a new node to `b`. At rest, the node
    /// is on the way from the middle between these two to `apex`, a corner that is not on their
    /// line, at this share of the way, 0 < share < 1. Returns the node.
    VertexId divide_face_beside(FaceId f, VertexId a, VertexId b, VertexId apex, double share);
    /// Divides a face, on both sides, by a new node that has an edge to each of its corners.
    /// Returns the node, which is at the mean of the corners at rest.
    VertexId divide_face_at_centre(FaceId f);
    /// Divides a cell by a face along a closed path of its edges, which meets no corner twice.
    /// Returns the new cell: the part to the right of the path, as seen from outside. The new face
    /// is the last one of both.
    CellId divide_cell(CellId e, std::span<const VertexId> path);

    /// Returns the record of a node that this edit has added.
    const VertexRecord& added(VertexId n) const {
        return nodes_added_[n.index() - node_capacity_before_];
    }

    /// Ends the transaction and returns its record. The epoch of the mesh increases by one, unless
    /// nothing changed.
    ChangeSet commit();

  private:
    /// One of the elements at an edge, which form a ring.
    struct RingElement {
        CellId element;
        int corner_a = 0, corner_b = 0;
        int next_face = 0;  ///< the face to the next element of the ring
    };

    /// The state of an element before the edit. The row of a polyhedron is what it was before.
    struct SavedRow {
        CellId element;
        bool was_alive;
        CellKind kind;
        std::array<VertexId, max_corners> corners;  // only as many as the row has
        std::array<FaceId, max_faces> neighbors;    // likewise
        std::uint8_t inside_faces;
        std::vector<FaceId> neighbors_of_polyhedron;  // instead
        CellShape shape;
        FaceId neighbor(int f) const {
            const auto& all = neighbors_of_polyhedron;
            const auto i = static_cast<std::size_t>(f);
            return kind == CellKind::polyhedron ? all[i] : neighbors[i];
        }
        int num_faces() const {
            return kind == CellKind::polyhedron ? static_cast<int>(neighbors_of_polyhedron.size())
                                                : traits(kind).num_faces;
        }
    };
    struct TouchedCorner {
        VertexId node;
        CellId element;  // may have died since; invalid if only the node matters
        auto operator<=>(const TouchedCorner&) const = default;
    };

    void require_alive(CellId e) const;
    void require_no_new_row(CellId e) const;
    void require_dividable(FaceId f) const;
    void save(CellId e);
    void touch_face(FaceId f);
    void part(FaceId f);
    void rewire(CellId e, VertexId from, VertexId to);
    CellShape& shape_of(CellId e);
    void update(CellId e);
    FaceId divide_face_by(FaceId f, VertexId a, VertexId b, VertexId middle);
    std::pair<FaceId, FaceId> divide_side(FaceId f, VertexId a, VertexId b, VertexId middle);
    VertexId add_node(const VertexRecord& record);
    bool collect_ring(CellId e, VertexId a, VertexId b);
    VertexId add_node_between(VertexId a, VertexId b, double t);
    CellId divide(const RingElement& at, VertexId middle);
    void require_older(CellId e, const char* what) const;
    void merge(VertexId survivor, VertexId absorbed, CellId at);
    void divide_nodes(std::vector<VertexRecord>& removed);
    void split_star(VertexId n, const std::vector<CellId>& candidates,
                    std::vector<VertexRecord>& removed);
    VertexId survivor_of(VertexId n) const;
    ChangeSet differences() const;

    Mesh& mesh_;
    const std::size_t node_capacity_before_, element_capacity_before_;
    bool is_open_ = true;
    std::vector<SavedRow> saved_;
    std::unordered_set<CellId> is_saved_;
    std::vector<TouchedCorner> touched_;
    std::vector<std::pair<VertexId, VertexId>> merged_;  // absorbed, survivor
    std::vector<VertexRecord> nodes_added_;
    std::vector<CellId> parents_;    // of the added elements, in ascending order
    std::vector<RingElement> ring_;  // scratch
    std::vector<CellId> star_;       // scratch
    Bisection bisection_;
};

/// Applies a recorded edit to a mesh, with the ids of the record.
/// Throws InputError if the mesh is not at changes.epoch_before.
void replay(Mesh& mesh, const ChangeSet& changes);

}  // namespace incise::topology
