// The mesh: which elements there are, which nodes they join, which faces they share.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/cell_map.h"
#include "incise/topology/living_ids.h"
#include "incise/topology/mesh_data.h"

namespace incise::topology {

struct BuiltMesh;

/// Elements over nodes, as flat arrays: the mesh that everyone reads and that edits decide by.
///
/// A combinatorial map of the same topology stands beside the arrays. Construction, edits and
/// replays write both, row by row. Nothing is copied from the map to the arrays; validate()
/// compares the two.
///
/// Ids are dense array indices in an order that keeps neighbours close (a Hilbert curve). The
/// number by which a user knows a node or element, its number in the source, is its label.
/// A node is one face-connected star of elements: elements that merely touch in a point or along
/// an edge have nodes of their own there.
///
/// Changed only through MeshEdit. Reading is safe from several threads.
class Mesh {
  public:
    /// Checks `data` (see mesh_check.h) and builds the mesh. Nodes that no element uses are left
    /// out, pinched ones divided, both with a warning.
    /// Throws InputError with every problem found. Cost: O(n log n), some 0.5 us an element.
    static BuiltMesh build(const MeshData& data);

    /// Grows by one with each edit; an undone edit takes it back.
    std::uint64_t epoch() const { return epoch_; }

    std::size_t num_nodes() const { return num_nodes_; }
    std::size_t num_elements() const { return num_elements_; }
    /// One more than the highest id ever given out: the size of arrays indexed by id.
    std::size_t node_capacity() const { return incident_elements_.size(); }
    std::size_t element_capacity() const { return kinds_.size(); }
    bool is_alive(NodeId n) const { return incident_elements_[n.index()].is_valid(); }
    bool is_alive(ElementId e) const { return alive_[e.index()] != 0; }
    /// The living ids in ascending order, to loop over.
    /// @pre The mesh is not edited while a loop runs.
    LivingIds<NodeId, Mesh> nodes() const { return {*this, node_capacity()}; }
    LivingIds<ElementId, Mesh> elements() const { return {*this, element_capacity()}; }

    /// Rest positions by node id, metres; those of dead nodes are their last ones.
    std::span<const Vec3> rest_positions() const { return rest_positions_; }
    const Vec3& rest_position(NodeId n) const { return rest_positions_[n.index()]; }

    CellKind kind(ElementId e) const { return kinds_[e.index()]; }
    int region(ElementId e) const { return regions_[e.index()]; }

    /// All elements at once, by element id, for renderers and other programs that copy them. Dead
    /// elements keep their last values.
    struct Connectivity {
        std::uint64_t epoch;  ///< of the mesh: another one means that the spans are gone
        std::span<const CellKind> kinds;
        std::span<const int> regions;
        std::span<const std::uint8_t> is_alive;
        /// Element e has the corners from corner_begin[e] to before corner_begin[e + 1].
        std::span<const std::size_t> corner_begin;
        std::span<const NodeId> corners;
        /// Likewise for its faces, in the order of cell_kind.h.
        std::span<const std::size_t> face_begin;
        std::span<const FaceId> neighbors;  ///< as neighbor()
    };
    /// @lifetime until the next edit. Cost: O(1).
    Connectivity connectivity() const {
        return {epoch_, kinds_, regions_, alive_, corner_begin_, corners_, face_begin_, neighbors_};
    }

    /// Corners in the order of cell_kind.h; for a dead element those it had last.
    std::span<const NodeId> corners(ElementId e) const {
        return {corners_.data() + corner_begin_[e.index()],
                corner_begin_[e.index() + 1] - corner_begin_[e.index()]};
    }
    /// Which corner of `e` the node is; -1 if none.
    int corner_of(ElementId e, NodeId n) const;
    int num_faces(ElementId e) const { return traits(kind(e)).num_faces; }
    NodeId face_corner(FaceId f, int position) const {
        return corners(f.element)[static_cast<std::size_t>(
            traits(kind(f.element)).face(f.face)[static_cast<std::size_t>(position)])];
    }
    int face_size(FaceId f) const {
        return static_cast<int>(traits(kind(f.element)).face(f.face).size());
    }
    /// The other side of a face; invalid on the boundary.
    FaceId neighbor(FaceId f) const {
        return neighbors_[face_begin_[f.element.index()] + static_cast<std::size_t>(f.face)];
    }

    /// Whether the face was joined to another in the source: inside the body, before any cut. A
    /// divided element's parts have what it had at the same places.
    bool was_inside(FaceId f) const {
        return was_inside_[face_begin_[f.element.index()] + static_cast<std::size_t>(f.face)] != 0;
    }

    /// Elements round a node in ascending order of id. Cost: O(star), about a microsecond.
    void star(NodeId n, std::vector<ElementId>& elements) const;
    /// The lowest element of the node's star; invalid for a dead node.
    ElementId incident_element(NodeId n) const { return incident_elements_[n.index()]; }

    /// The number by which the user knows it: that of the source, or the id for one born later.
    std::int64_t label(NodeId n) const;
    std::int64_t label(ElementId e) const;
    /// The nodes that came from point `label` of the source: none if it was not used or is gone
    /// for good, several if it was pinched. The label of a point that was welded to another gives
    /// the nodes of that one. The caller checks is_alive.
    std::vector<NodeId> nodes_with_label(std::int64_t label) const;
    /// Points of the source.
    std::size_t num_source_points() const { return node_labels_.size(); }

    /// The second record, for validate(). A run reads it only to check what a checkpoint led to.
    const CellMap& map() const { return map_; }

  private:
    friend class MeshArchive;
    friend class MeshEdit;
    friend class MeshImport;
    friend class MeshReplay;
    Mesh() = default;

    void append_element_row(CellKind kind, int region, std::span<const NodeId> corners);
    void inherit_inside(ElementId e, ElementId parent);
    void truncate(std::size_t node_capacity, std::size_t element_capacity);
    /// Joins two faces in the map and in the arrays; their corners are equal, or `shift` tells
    /// how they meet.
    void glue(FaceId a, FaceId b, int shift);
    void unglue(FaceId a);
    void set_neighbor(FaceId f, FaceId other) {
        neighbors_[face_begin_[f.element.index()] + static_cast<std::size_t>(f.face)] = other;
    }

    std::uint64_t epoch_ = 0;
    std::size_t num_nodes_ = 0, num_elements_ = 0;

    std::vector<Vec3> rest_positions_;
    std::vector<ElementId> incident_elements_;

    std::vector<CellKind> kinds_;
    std::vector<std::uint8_t> alive_;
    std::vector<int> regions_;
    std::vector<std::size_t> corner_begin_{0}, face_begin_{0};
    std::vector<NodeId> corners_;
    std::vector<FaceId> neighbors_;
    std::vector<std::uint8_t> was_inside_;  // by face

    std::vector<std::int64_t> node_labels_, element_labels_;
    std::vector<NodeId> label_nodes_;                       ///< label -> node, the first if pinched
    std::vector<std::pair<std::int64_t, NodeId>> pinched_;  ///< label -> further nodes, sorted

    CellMap map_;
};

struct BuiltMesh {
    Mesh mesh;
    std::vector<std::string> warnings;
};

/// Appends, in ascending order, the elements that `start` reaches round its corner `n` through
/// faces at `n`. Cost: O(star^2) comparisons; stars are small.
void collect_star(const Mesh& mesh, NodeId n, ElementId start, std::vector<ElementId>& elements);

/// Appends the elements round the edge from `a` to `b` that tetrahedron `e` reaches through faces
/// at the edge, in their order.
void collect_edge_ring(const Mesh& mesh, ElementId e, NodeId a, NodeId b,
                       std::vector<ElementId>& elements);

/// Position in b's face of the node at position 0 of a's, if the two faces have the same nodes
/// and run in opposite directions; -1 otherwise.
int matching_shift(const Mesh& mesh, FaceId a, FaceId b);

/// Area of a face at rest, m2; of a quadrilateral that of its bilinear patch's mean plane.
double rest_area(const Mesh& mesh, FaceId f);

/// Piece number of each element (by id; -1 for dead ones): elements joined through faces have the
/// same; pieces are numbered from 0 in the order of their lowest element. Cost: a look at each
/// face.
struct Components {
    std::vector<int> of_element;
    int count = 0;
};
Components components(const Mesh& mesh);

/// Faces of living elements without a neighbour, in ascending order.
std::vector<FaceId> boundary_faces(const Mesh& mesh);

/// The living part as plain arrays, in ascending order of ids, with the given positions by node
/// id as points. `nodes` and `elements`, when not null, receive the ids of the rows.
MeshData to_mesh_data(const Mesh& mesh, std::span<const Vec3> positions,
                      std::vector<NodeId>* nodes = nullptr,
                      std::vector<ElementId>* elements = nullptr);

}  // namespace incise::topology
