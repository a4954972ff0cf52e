// The combinatorial map of a mesh: CGAL's linear cell complex, addressed by the ids of the mesh.
// Its operations work on darts directly and change only the cells that are their arguments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

class Mesh;

/// A combinatorial map that stores the topology of a mesh a second time, so that the arrays of the
/// mesh can be checked. Internal to topology. It is written together with the arrays; validate()
/// and tests read it.
///
/// Each element has one volume, and each of its faces has one cycle of darts. The dart at position
/// p of face f starts at the corner that cell_kind.h lists there. Vertices carry the rest position
/// and the node id, volumes carry the element id. Edges and faces carry nothing.
class CellMap {
  public:
    CellMap();
    ~CellMap();
    CellMap(CellMap&&) noexcept;
    CellMap& operator=(CellMap&&) noexcept;

    /// Adds the cell `e`, which is joined to no other cell. Nodes without a vertex get one.
    void add_element(CellId e, CellKind kind, std::span<const VertexId> corners,
                     std::span<const Vec3> rest_positions);
    /// Removes the cell `e`. Vertices that lose their last dart are removed too.
    /// @pre  no face of `e` is joined to another face
    void remove_element(CellId e);
    /// Deletes the rows from these capacities on.
    /// @pre  none of these rows is in use
    void truncate(std::size_t node_capacity, std::size_t element_capacity);
    /// Makes `n` the node at a corner of `e`. A vertex that loses its last dart is removed.
    void set_corner(CellId e, int corner, VertexId n, const Vec3& rest_position);
    /// Makes a dart at this corner of `e` the dart that CGAL stores for the vertex of `n`.
    void set_incident_element(VertexId n, CellId e, int corner);
    /// Joins two faces that are not joined yet. The corner at position 0 of `a` meets the corner at
    /// position `shift` of `b`.
    void glue(FaceId a, FaceId b, int shift);
    /// Separates the two faces at a joined face.
    void unglue(FaceId a);

    std::size_t num_vertices() const;
    std::size_t num_volumes() const;
    std::size_t num_darts() const;
    /// True if CGAL's own check finds the map valid. Cost: about a microsecond an element.
    bool is_valid() const;
    /// Compares the map with the arrays of `mesh`, dart by dart. Returns a description of each
    /// difference.
    std::vector<std::string> differences_to(const Mesh& mesh) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace incise::topology
