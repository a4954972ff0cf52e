// The update of a fragment mesh after an edit of the material. Internal to topology.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Finds the fragments and their nodes anew near an edit. Used once.
class FragmentUpdate {
  public:
    FragmentUpdate(FragmentMesh& fragments, const Mesh& material, const ChangeSet& changes)
        : fragments_(fragments), material_(material), changes_(changes) {}

    FragmentChanges run();

  private:
    struct Neighbor {
        std::size_t part;
        double area;  // of the shared faces, at rest, m2; only found for light parts
    };
    /// Cells of one carrier that hang together inside it.
    struct Part {
        ElementId carrier;
        std::vector<ElementId> cells;     // in ascending order
        std::vector<Neighbor> neighbors;  // in the order of their heads; see neighbors()
        double volume = 0.0;              // at rest, m3
        std::size_t master = 0;           // in an open carrier: the part whose fragment carries it
        ElementId fragment;               // that carries it
        std::int32_t local = -1;          // scratch of find_groups()
        bool is_light = false;
        bool is_element = false;     // carried by a fragment of its own carrier
        bool has_neighbors = false;  // found
        bool is_in_cluster = false;  // see light_cluster()
        bool is_waiting = false;     // see join_in_rounds()
        ElementId head() const { return cells.front(); }
    };
    /// Parts that are connected at a node before any cut, with the node that they get.
    struct Group {
        NodeId origin;
        NodeId before;                     // the lowest node that they had there; invalid if none
        std::vector<ElementId> fragments;  // the elements among them, in ascending order
    };
    /// The parts from `begin` to before `end`.
    struct PartRange {
        std::size_t begin, end;
    };

    void follow_cells();
    PartRange parts_of(ElementId carrier);
    std::size_t part_of(ElementId cell);
    void find_parts(ElementId carrier);
    void add_part(ElementId carrier, std::vector<ElementId> cells, double volume);
    bool is_added(ElementId cell) const;
    const std::vector<Neighbor>& neighbors(std::size_t index);

    void join_light_parts();
    std::vector<std::size_t> light_cluster();
    bool are_in_one_region(std::size_t a, std::size_t b) const {
        return fragments_.regions_[parts_[a].carrier.index()] ==
               fragments_.regions_[parts_[b].carrier.index()];
    }
    void join_in_rounds(std::vector<std::size_t>& lights);
    void join_larger_lights(const std::vector<std::size_t>& lights);

    void assign_fragments();
    void assign_fragments_of(ElementId carrier);
    void carry_cells();
    void update_shares();
    double share_of(ElementId fragment);
    ElementId add_fragment(ElementId carrier, ElementId parent);

    void assign_nodes();
    void find_groups(NodeId origin, std::vector<Group>& groups);
    ElementId parent_of(ElementId fragment) const {
        return fragment.index() < element_capacity_before_
                   ? ElementId()
                   : parents_[fragment.index() - element_capacity_before_];
    }
    NodeId node_before(ElementId fragment, NodeId origin) const;
    void note_corners(ElementId fragment);
    NodeId add_node(const Group& group);
    void set_node(ElementId fragment, NodeId origin, NodeId node);
    void remove_unused_nodes(const std::vector<NodeId>& touched,
                             const std::map<NodeId, NodeId>& survivors);

    FragmentChanges differences();

    FragmentMesh& fragments_;
    const Mesh& material_;
    const ChangeSet& changes_;

    std::vector<ElementId> touched_carriers_;  // in ascending order
    std::vector<ElementId> open_carriers_;     // these, and those whose parts are joined anew
    std::vector<ElementId> carriers_found_;    // whose parts are known
    std::deque<Part> parts_;                   // those of a carrier follow each other

    std::vector<std::pair<ElementId, ElementId>> fragment_before_;  // cell, and what carried it
    std::unordered_map<ElementId, std::vector<NodeId>> corners_before_;  // of fragments that change
    std::unordered_map<ElementId, double> shares_before_;
    std::vector<ElementId> parents_;  // of the added fragments, in ascending order
    std::vector<ElementId> died_;
    std::vector<NodeRecord> nodes_added_, nodes_removed_;
    std::size_t node_capacity_before_ = 0, element_capacity_before_ = 0;
};

}  // namespace incise::topology
