// The update of a fragment mesh after an edit of the material. Internal to topology.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "incise/fragments/fragment_mesh.h"
#include "incise/fragments/fragment_parts.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// Finds the fragments and their nodes anew near an edit. Used once.
class FragmentUpdate {
  public:
    FragmentUpdate(FragmentMesh& fragments, const topology::Mesh& material,
                   const topology::ChangeSet& changes)
        : fragments_(fragments), material_(material), changes_(changes) {}

    FragmentChanges run();
    /// Finds the fragments of a body that is built, in which each carrier is still one fragment.
    /// @param carriers  those that consist of several cells, or are only a part of their volume
    static void divide(FragmentMesh& fragments, const topology::Mesh& material,
                       std::vector<CarrierId> carriers);

  private:
    using CarrierPart = FragmentParts::CarrierPart;
    /// Parts that are connected at a node before any cut, with the node that they get.
    struct Group {
        NodeId origin;
        NodeId before;                     // the node that they had there; invalid if none
        std::vector<ElementId> fragments;  // the elements among them, in ascending order
    };
    void begin();
    void follow_cells();
    void find_fragments();
    bool is_added(CellId cell) const;

    void assign_fragments();
    void assign_fragments_of(CarrierId carrier);
    void carry_cells();
    void update_shares();
    double share_of(ElementId fragment);
    ElementId add_fragment(CellId cell);

    void assign_nodes();
    bool is_settled(NodeId origin, std::span<const std::size_t> parts, DisjointSet& connected);
    void find_groups(NodeId origin, std::vector<Group>& groups);
    ElementId parent_of(ElementId fragment) const {
        return fragment.index() < element_capacity_before_
                   ? ElementId()
                   : parents_[fragment.index() - element_capacity_before_];
    }
    NodeId node_before(ElementId fragment, NodeId origin) const;
    NodeId node_before(const CarrierPart& part, NodeId origin) const;
    NodeId node_at(std::span<const NodeId> corners, NodeId origin) const;
    std::span<const NodeId> corners_before(ElementId fragment) const;
    void note_corners(ElementId fragment);
    /// Returns the node into which a node is merged by the edit: itself, if it is not.
    NodeId survivor_of(NodeId n) const;
    void merge(NodeId a, NodeId b);
    void merge_nodes_of_fragments();
    NodeId add_node(const Group& group);
    void set_node(ElementId fragment, NodeId origin, NodeId node);
    void remove_unused_nodes(std::vector<NodeId> touched);

    FragmentChanges differences();

    FragmentMesh& fragments_;
    const topology::Mesh& material_;
    const topology::ChangeSet& changes_;

    std::vector<CarrierId> touched_carriers_;  // in ascending order
    std::vector<CarrierId> parted_carriers_;   // those of them that were not only divided
    std::vector<CarrierId> open_carriers_;     // these, and those whose parts are joined anew
    FragmentParts parts_{fragments_, material_};

    /// A cell that another fragment carries now, or none.
    struct CellBefore {
        CellId cell;
        ElementId before;     // that carried it; invalid if the edit added the cell
        ElementId inherited;  // that carried it, or its parent
        bool was_around;      // the cell, or its parent: see FragmentMesh::is_carried_around()
    };
    std::vector<CellBefore> fragment_before_;
    std::unordered_map<ElementId, std::vector<NodeId>> corners_before_;  // of fragments that change
    std::unordered_map<ElementId, double> shares_before_;
    bool has_overlaps_ = false;
    std::vector<ElementId> parents_;              // of the added fragments, in ascending order
    std::vector<std::uint8_t> is_from_own_part_;  // of each, if it is a part of its parent
    std::vector<ElementId> died_;
    std::vector<ElementId> part_shares_changed_;  // those of their tetrahedra
    std::map<NodeId, NodeId> merged_;  // nodes of parts that were joined again, with lower ones
    std::vector<NodeRecord> nodes_added_, nodes_removed_;
    std::size_t node_capacity_before_ = 0, element_capacity_before_ = 0;
};

}  // namespace incise::fragments
