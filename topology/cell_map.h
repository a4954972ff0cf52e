// The combinatorial map beside a mesh: CGAL's linear cell complex, addressed by the mesh's ids.
// Its local operators work on darts directly and touch only the cells that they name.
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

/// Internal to topology: a second record, by which the mesh's arrays can be checked. It is written
/// with them, and only validate() and tests read it.
///
/// Every element has one volume, each of its faces one cycle of darts; the dart at position p of
/// face f starts at the corner that cell_kind.h lists there. Vertices carry the rest point and the
/// node id, volumes the element id; edges and faces carry nothing.
class CellMap {
  public:
    CellMap();
    ~CellMap();
    CellMap(CellMap&&) noexcept;
    CellMap& operator=(CellMap&&) noexcept;

    /// Adds the free-standing cell `e`. Nodes that have no vertex yet get one.
    void add_element(ElementId e, CellKind kind, std::span<const NodeId> corners,
                     std::span<const Vec3> rest_positions);
    /// Removes the cell `e`, whose faces are all free. Vertices without a dart die with it.
    void remove_element(ElementId e);
    /// Forgets the rows above these capacities; none of them is in use.
    void truncate(std::size_t node_capacity, std::size_t element_capacity);
    /// Makes `n` the node at a corner of `e`. The vertex that loses its last dart dies.
    void set_corner(ElementId e, int corner, NodeId n, const Vec3& rest_position);
    /// Makes a dart at this corner of `e` the one that CGAL finds the vertex of `n` by.
    void set_incident_element(NodeId n, ElementId e, int corner);
    /// Joins two free faces; corner 0 of a's face meets the corner at position `shift` of b's.
    void glue(FaceId a, FaceId b, int shift);
    /// Frees both sides of a joined face.
    void unglue(FaceId a);

    std::size_t num_vertices() const;
    std::size_t num_volumes() const;
    std::size_t num_darts() const;
    /// CGAL's own check. Cost: about a microsecond an element.
    bool is_valid() const;
    /// Compares dart by dart with the flat arrays of `mesh`; says where they differ.
    std::vector<std::string> differences_to(const Mesh& mesh) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace incise::topology
