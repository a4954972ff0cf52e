// The mesh: its elements, their nodes, and the faces that they share.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/cell_shape.h"
#include "incise/topology/id_map.h"
#include "incise/topology/living_ids.h"
#include "incise/topology/mesh_data.h"
#include "incise/topology/whole_cell.h"

namespace incise::topology {

struct BuiltMesh;

/// Reserves room in lists for `size` values and for a sixteenth more: the first edits then do not
/// copy them. A cut through a cube of 100,000 tetrahedra adds so many.
void reserve_with_room(std::size_t size, auto&... lists) { (lists.reserve(size + size / 16), ...); }

/// A volume mesh: elements over nodes, as flat arrays.
///
/// The rows of corners and neighbours are a combinatorial map: each dart is a position in a face of
/// a cell, and its links follow from the rows. to_linear_cell_complex() writes them as CGAL's.
///
/// Ids are dense array indices. Their order follows a Hilbert curve, which keeps neighbours close.
/// A body with carriers keeps the order of its source, as it was cut in this order: see build().
/// The label of a node or element is its number in the source, by which the user knows it.
///
/// The elements at a node are connected with each other through faces at this node. Elements that
/// touch only in a point or along an edge therefore have different nodes there.
///
/// A mesh is changed only by MeshEdit and replay(). Several threads may read a mesh at the same
/// time.
class Mesh {
  public:
    /// Checks `data` (see mesh_check.h) and builds the mesh. Points that no element uses are left
    /// out. Pinched points, at which elements are not connected through faces, get several nodes.
    /// There are warnings about both. A quadrilateral that meets two triangles is divided by the
    /// diagonal that they share, and joined to both: see find_joined_quads().
    /// Cells and used points of data with carriers keep their order. Ties between fragments, which
    /// ids decide, then come out as in the body that was written, and so does the next cut.
    /// Throws InputError with the errors of check(). Cost: O(n log n), some 0.5 us an element.
    /// @param data    the mesh
    /// @param advice  the words of the warning of points that are not joined
    static BuiltMesh build(const MeshData& data, const WeldAdvice& advice = {});

    /// Returns the epoch: the number of edits so far, without those that were undone.
    std::uint64_t epoch() const { return epoch_; }

    std::size_t num_nodes() const { return num_nodes_; }
    std::size_t num_elements() const { return num_elements_; }
    /// Returns one more than the highest id, alive or dead: the size of arrays indexed by id.
    std::size_t node_capacity() const { return incident_elements_.size(); }
    std::size_t element_capacity() const { return kinds_.size(); }
    bool is_alive(VertexId n) const { return incident_elements_[n.index()].is_valid(); }
    bool is_alive(CellId e) const { return alive_[e.index()] != 0; }
    /// Returns the ids of the living nodes in ascending order, as a range.
    /// @pre  the mesh is not edited while a loop over the range runs
    LivingIds<VertexId, Mesh> nodes() const { return {*this, node_capacity()}; }
    /// Returns the ids of the living elements as nodes() does those of the nodes.
    LivingIds<CellId, Mesh> elements() const { return {*this, element_capacity()}; }

    /// Returns the rest positions by node id, m. Dead nodes keep their last rest position.
    std::span<const Vec3> rest_positions() const { return rest_positions_; }
    const Vec3& rest_position(VertexId n) const { return rest_positions_[n.index()]; }

    CellKind kind(CellId e) const { return kinds_[e.index()]; }
    int region(CellId e) const { return regions_[e.index()]; }

    /// All elements at once, by element id, for renderers and other programs that copy them. Dead
    /// elements keep their last values. Corners and faces of polyhedra are not here.
    struct Connectivity {
        std::uint64_t epoch;  ///< of the mesh: another one means that the spans are gone
        std::span<const CellKind> kinds;
        std::span<const int> regions;
        std::span<const std::uint8_t> is_alive;
        /// Element e has the corners from corner_begin[e] to before corner_begin[e + 1].
        std::span<const std::uint32_t> corner_begin;
        std::span<const VertexId> corners;
        /// Likewise for its faces, in the order of cell_kind.h.
        std::span<const std::uint32_t> face_begin;
        std::span<const FaceId> neighbors;  ///< as neighbor()
    };
    /// Returns views of the connectivity. Cost: O(1).
    /// @lifetime Until the next edit.
    Connectivity connectivity() const {
        return {epoch_, kinds_, regions_, alive_, corner_begin_, corners_, face_begin_, neighbors_};
    }

    /// Returns the corners in the order of cell_kind.h, those of a polyhedron in the order in which
    /// its faces name them. A dead element keeps its last corners.
    std::span<const VertexId> corners(CellId e) const {
        return is_polyhedron(e) ? std::span<const VertexId>(polyhedron(e).corners) : row(e);
    }
    /// Returns the volume of a polyhedron at rest, m3: see rest_volume().
    double rest_volume_of_polyhedron(CellId e) const;
    /// True if the cell has a shape of its own, which edits have made, here or before the source
    /// was written, or the division of its faces at import: see whole_cell().
    bool is_polyhedron(CellId e) const { return kinds_[e.index()] == CellKind::polyhedron; }
    /// Returns which corner of `e` the node is; -1 if it is none.
    int corner_of(CellId e, VertexId n) const;
    int num_faces(CellId e) const {
        return is_polyhedron(e) ? polyhedron(e).shape.num_faces() : traits(kind(e)).num_faces;
    }
    /// Returns the node at a position in the face, in the order of cell_kind.h.
    VertexId face_corner(FaceId f, int position) const {
        if (is_polyhedron(f.cell))
            return polyhedron(f.cell).shape.face(f.face)[static_cast<std::size_t>(position)];
        return row(f.cell)[static_cast<std::size_t>(
            traits(kind(f.cell)).face(f.face)[static_cast<std::size_t>(position)])];
    }
    int face_size(FaceId f) const {
        return static_cast<int>(is_polyhedron(f.cell) ? polyhedron(f.cell).shape.face(f.face).size()
                                                      : traits(kind(f.cell)).face(f.face).size());
    }
    /// Returns the other side of a face; invalid on the boundary.
    FaceId neighbor(FaceId f) const {
        return is_polyhedron(f.cell)
                   ? polyhedron(f.cell).neighbors[static_cast<std::size_t>(f.face)]
                   : neighbors_[face_begin_[f.cell.index()] + static_cast<std::size_t>(f.face)];
    }
    /// Returns the faces of a cell of any kind.
    CellShape shape(CellId e) const;
    /// Returns the faces that a cell of another kind has, or had before it became a polyhedron.
    /// @param kind  the kind
    CellShape shape_of_row(CellId e, CellKind kind) const;

    /// Returns the cell as the source has it. A hexahedron, wedge or pyramid of which
    /// quadrilaterals are divided, because they meet triangles, is a polyhedron in the mesh.
    /// Nothing for a cell to which edits have given other faces.
    std::optional<WholeCell> whole_cell(CellId e) const;

    /// True if the face lay inside the body before any cut: it is, or was, joined to another face.
    /// The parts of a face that is divided take its value. The source can name further faces:
    /// MeshData::cut_faces.
    bool was_inside(FaceId f) const {
        return is_polyhedron(f.cell) ? polyhedron(f.cell).shape.is_inside(f.face)
                                     : (inside_faces_[f.cell.index()] >> f.face & 1) != 0;
    }
    /// True if the face is on a cut: it is on the boundary, and lay inside the body before any cut.
    bool is_on_cut(FaceId f) const { return !neighbor(f).is_valid() && was_inside(f); }

    /// Writes the elements at a node (its star) to `elements`, in ascending order. A dead node has
    /// none. Cost: about a microsecond; see collect_star().
    void star(VertexId n, std::vector<CellId>& elements) const;
    /// Returns the element with the lowest id at the node; invalid for a dead node.
    CellId incident_element(VertexId n) const { return incident_elements_[n.index()]; }

    /// Returns the number by which the user knows the node or element: its number in the source, or
    /// its id if an edit has made it.
    std::int64_t label(VertexId n) const;
    std::int64_t label(CellId e) const;
    /// Returns the nodes with this label: several if the point of the source was pinched, none if
    /// there is no such label. A point that was welded to another one gives the nodes of that other
    /// point. Nodes may be dead, for example if no element used the point: check is_alive().
    std::vector<VertexId> nodes_with_label(std::int64_t label) const;
    /// Returns the carriers of the source, for FragmentMesh: by id of the elements that the mesh
    /// was built with. Empty if the body had no cuts, and in a mesh that an archive has restored.
    const Carriers& source_carriers() const { return source_carriers_; }
    /// Returns the number of points in the source.
    std::size_t num_source_points() const { return node_labels_.size(); }

  private:
    friend class MeshArchive;
    friend class MeshEdit;
    friend class MeshImport;
    friend class MeshReplay;
    Mesh() = default;

    void append_element_row(CellKind kind, int region, std::span<const VertexId> corners);
    void truncate(std::size_t node_capacity, std::size_t element_capacity);
    /// Joins two faces, which makes them inside for ever: see was_inside().
    void glue(FaceId a, FaceId b);
    void unglue(FaceId a);
    void set_inside(FaceId f);
    void set_neighbor(FaceId f, FaceId other) {
        (is_polyhedron(f.cell)
             ? polyhedra_.at(f.cell).neighbors[static_cast<std::size_t>(f.face)]
             : neighbors_[face_begin_[f.cell.index()] + static_cast<std::size_t>(f.face)]) = other;
    }

    /// A cell with a shape of its own. The row that it had before stays as it was.
    struct Polyhedron {
        CellShape shape;
        std::vector<VertexId> corners;             // of the faces, each once
        std::vector<FaceId> neighbors;             // by face
        CellKind row_kind = CellKind::polyhedron;  // that of the cell before it became one
        Diagonals diagonals;  // that the cell had from the start: see whole_cell()
        static void archive(auto& ar, auto& self) {
            ar(self.shape, self.neighbors, self.row_kind, self.diagonals);
        }
    };
    const Polyhedron& polyhedron(CellId e) const { return polyhedra_.at(e); }
    std::span<const VertexId> row(CellId e) const {
        return {corners_.data() + corner_begin_[e.index()],
                corner_begin_[e.index() + 1] - corner_begin_[e.index()]};
    }
    /// Gives a cell another kind, or another shape. Faces that it has before and after keep their
    /// neighbours; faces that it loses have none.
    /// @param shape  of a polyhedron; that of another kind is in its row
    void set_shape(CellId e, CellKind kind, CellShape shape);

    std::uint64_t epoch_ = 0;
    std::size_t num_nodes_ = 0, num_elements_ = 0;

    std::vector<Vec3> rest_positions_;
    std::vector<CellId> incident_elements_;

    std::vector<CellKind> kinds_;
    std::vector<std::uint8_t> alive_;
    std::vector<int> regions_;
    std::vector<std::uint32_t> corner_begin_{0}, face_begin_{0};
    std::vector<VertexId> corners_;
    std::vector<FaceId> neighbors_;
    std::vector<std::uint8_t> inside_faces_;  // by element, bit f for face f: see was_inside()
    IdMap<CellId, Polyhedron> polyhedra_;

    std::vector<std::int32_t> node_labels_, element_labels_;  // numbers in the source
    std::vector<VertexId> label_nodes_;  ///< by label; the first node if pinched
    std::vector<std::pair<std::int64_t, VertexId>> pinched_;  ///< label, further node; sorted
    Carriers source_carriers_;
};

/// A new mesh, with warnings about its source.
struct BuiltMesh {
    Mesh mesh;
    std::vector<std::string> warnings;
    std::vector<std::string> joins;  ///< which quadrilaterals were joined: report_of_joins()
};

/// Appends the elements that are connected with `start` through faces at its node `n`, in ascending
/// order. Cost: O(k^2) comparisons for k elements, which are few.
void collect_star(const Mesh& mesh, VertexId n, CellId start, std::vector<CellId>& elements);

/// Returns the position in face `b` of the node at position 0 of face `a`, if the two faces have
/// the same nodes in opposite directions; else -1.
int matching_shift(const Mesh& mesh, FaceId a, FaceId b);

/// Returns the area of a face at rest, m2. For a face that is not plane it is the area of the
/// projection onto its mean plane.
double rest_area(const Mesh& mesh, FaceId f);

/// Returns the volume of an element at rest, m3.
double rest_volume(const Mesh& mesh, CellId e);

/// The connected components of a mesh: sets of elements that are joined through faces. They are
/// numbered from 0 in the order of their lowest element.
struct Components {
    std::vector<int> of_element;  ///< number of the component, by element id; -1 for dead elements
    int count = 0;
};
/// Returns the connected components. Cost: O(#faces).
Components components(const Mesh& mesh);
/// Returns how many there are, with less memory.
int num_components(const Mesh& mesh);

/// Returns the faces of living elements that have no neighbour, in ascending order.
std::vector<FaceId> boundary_faces(const Mesh& mesh);

/// Returns a cell as a source can have it, which is then joined as it is here. Nothing for a
/// polyhedron, also for one of which a quadrilateral is joined to one triangle only.
std::optional<WholeCell> cell_of_source(const Mesh& mesh, CellId e);

/// Returns the living nodes and elements as plain arrays, in ascending order of ids, and which of
/// their faces are on cuts. A polyhedron that is as the source has it is of its kind there: see
/// Mesh::whole_cell().
/// @param mesh       the mesh
/// @param positions  by node id; the points of the result
/// @param nodes      if not null, receives the node id of each point
/// @param elements   if not null, receives the element id of each cell
MeshData to_mesh_data(const Mesh& mesh, std::span<const Vec3> positions,
                      std::vector<VertexId>* nodes = nullptr,
                      std::vector<CellId>* elements = nullptr);

}  // namespace incise::topology
