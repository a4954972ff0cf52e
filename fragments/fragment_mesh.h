// The mesh of the physics of a body that is cut: fragments of the elements before any cut.
// Source: Molino, Bao, Fedkiw 2004; Sifakis, Der, Fedkiw 2007; Badia, Verdugo, Martin 2018.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "incise/base/types.h"
#include "incise/fragments/corner_nodes.h"
#include "incise/fragments/embedded_point.h"
#include "incise/fragments/fragment_changes.h"
#include "incise/fragments/list_or_one.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/living_ids.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// A fragment with less than this share of its carrier is light.
inline constexpr double default_light_share = 0.2;

/// Fragments and their nodes: the elements and nodes of the physics.
///
/// The *material* of a body is a Mesh, whose elements are called cells here. A *carrier* is a cell
/// as it was before any cut: its parts share it. A *fragment* consists of those parts of a carrier
/// that hang together through faces inside the carrier. It moves as the whole carrier would, with
/// the share of the carrier's mass and stiffness that its volume is of the carrier's volume. Its
/// corners are those of the carrier, whether there is material at them or not.
///
/// A node of the carrier has as many copies as its fragments have connected groups. Two fragments
/// are connected at a node if cells of theirs share a face in a face of their carriers at the node.
/// A *light* fragment is no element of its own: another fragment carries its cells. It has little
/// volume, and nothing holds it: see default_light_share and constrain().
///
/// A body without cuts has one carrier and one fragment for each cell and one node for each vertex,
/// with the same numbers. Fragments and nodes that edits add have numbers of their own.
class FragmentMesh {
  public:
    /// Takes every living element of `material` as a carrier, unless it is a part of one of
    /// Mesh::source_carriers(): the fragments of a body that was read are those of the body that
    /// was written. Their ids, and those of their nodes, can be others. Cost: O(n log n).
    /// @param material     the body as it was built, before its first edit
    /// @param light_share  see default_light_share; with 0 no fragment is light
    /// @param held         see constrain()
    explicit FragmentMesh(const topology::Mesh& material, double light_share = default_light_share,
                          std::span<const VertexId> held = {});

    /// Sets the vertices of the material whose positions are prescribed. No fragment with material
    /// at one of them is light, so that it stays where it is held. A vertex that an edit makes of
    /// held ones only is held as well. Fragments that exist stay as they are until an edit beside
    /// them.
    void constrain(std::span<const VertexId> vertices);
    /// Follows an edit of the material, and returns what it did to the fragments.
    /// Throws InputError, and changes nothing, for an edit out of turn.
    /// Cost: proportional to the elements at the nodes of the carriers that the edit touches.
    FragmentChanges apply(const topology::Mesh& material, const topology::ChangeSet& changes);
    /// Takes back an edit that apply() has followed, with all its ids: those that it gave out are
    /// free again.
    /// @param material  the material, on which the inverse of the edit was replayed
    /// @param back      the inverse of what apply() returned
    /// Throws InputError, and changes nothing, unless the edit is the last one.
    /// Cost: proportional to the edit.
    void go_back(const topology::Mesh& material, const FragmentChanges& back);

    /// Returns the epoch of the material that the fragments are those of.
    std::uint64_t epoch() const { return epoch_.value(); }
    std::size_t node_capacity() const { return origins_.size(); }
    std::size_t element_capacity() const { return is_alive_.size(); }
    bool is_alive(NodeId n) const { return is_node_alive_[n.index()] != 0; }
    bool is_alive(ElementId e) const { return is_alive_[e.index()] != 0; }
    std::size_t num_nodes() const { return num_nodes_; }
    std::size_t num_elements() const { return num_elements_; }
    topology::LivingIds<NodeId, FragmentMesh> nodes() const { return {*this, node_capacity()}; }
    topology::LivingIds<ElementId, FragmentMesh> elements() const {
        return {*this, element_capacity()};
    }

    topology::CellKind kind(ElementId e) const { return kind_of(carrier(e)); }
    int region(ElementId e) const { return region_of_carrier(carrier(e)); }
    /// Returns the diagonals that divide quadrilaterals of the carrier, since they meet triangles.
    topology::Diagonals diagonals(ElementId e) const { return diagonals_of(carrier(e)); }
    /// Returns the corners in the order of cell_kind.h. A dead fragment keeps its last corners.
    std::span<const NodeId> corners(ElementId e) const {
        return {corners_.data() + corner_begin_[e.index()],
                corner_begin_[e.index() + 1] - corner_begin_[e.index()]};
    }
    /// Returns which corner of `e` the node is; -1 if it is none.
    int corner_of(ElementId e, NodeId n) const;
    /// True if the position of a node of the material is prescribed; see constrain().
    bool is_constrained(VertexId n) const { return is_constrained_[n.index()] != 0; }
    /// Returns is_constrained() of all vertices, and sets it again.
    /// @pre  set_constrained(): there is one for each vertex of the material, also for those
    /// removed
    std::span<const std::uint8_t> constrained() const { return is_constrained_; }
    void set_constrained(std::vector<std::uint8_t> held) { is_constrained_ = std::move(held); }
    /// Returns the volume that the fragment carries over that of its carrier. It is exactly 1 for a
    /// carrier that is whole, or cut in part. It exceeds 1 if cells of others outweigh those that
    /// are missing.
    double volume_share(ElementId e) const {
        const auto it = shares_.find(e);
        return it == shares_.end() ? 1.0 : it->second;
    }
    /// Returns by tetrahedron of CentreDivision how much of it the fragment has. The tetrahedra of
    /// the carrier, times their shares, have the volume of the fragment, unless a cut with bends
    /// below the size of a cell has left parts that reach into each other. What the fragment
    /// carries of others is in all tetrahedra alike. Empty for a tetrahedron, and for a fragment
    /// whose own material is the whole carrier: it has the volume share of each.
    /// @lifetime Until the next edit.
    std::span<const double> part_shares(ElementId e) const {
        const auto it = part_shares_.find(e);
        return it == part_shares_.end() ? std::span<const double>() : it->second;
    }
    /// Returns the volume of the carrier at rest, m3.
    double carrier_volume(ElementId e) const { return volume_of(carrier(e)); }
    /// Returns the volume of the material that the fragment carries, at rest, m3.
    double volume(ElementId e) const { return volume_share(e) * carrier_volume(e); }
    const Vec3& rest_position(NodeId n) const { return rest_positions_[n.index()]; }
    std::span<const Vec3> rest_positions() const { return rest_positions_; }
    /// Returns the node before any cut that the node is, or of which it is a copy. Of several ones
    /// with the same rest position, it is the lowest.
    NodeId origin(NodeId n) const { return origins_[n.index()]; }
    /// Returns the vertex that the origin of a node was before any cut. Invalid if the body was
    /// built with carriers and has no material there.
    VertexId vertex_of_origin(const topology::Mesh& material, NodeId n) const;
    /// Writes the fragments with the node as a corner to `elements`, in ascending order.
    void star(NodeId n, std::vector<ElementId>& elements) const;
    /// Returns the lowest fragment with the node as a corner; invalid for a dead node.
    ElementId incident_element(NodeId n) const;

    /// Returns the carrier of a fragment: the element that the body had before any cut. A carrier
    /// of the source has the id of its lowest cell.
    CarrierId carrier(ElementId e) const {
        const std::size_t num_carriers = kinds_.size();
        return e.index() < num_carriers ? with_number_of<CarrierId>(e)
                                        : carriers_of_added_[e.index() - num_carriers];
    }
    /// Returns the kind of a carrier.
    topology::Diagonals diagonals_of(CarrierId carrier) const {
        return diagonals_.empty() ? topology::Diagonals() : diagonals_[carrier.index()];
    }
    topology::CellKind kind_of(CarrierId carrier) const { return kinds_[carrier.index()]; }
    /// Returns the carrier of a cell of the material.
    CarrierId carrier_of_cell(CellId cell) const { return carrier_of_cell_[cell.index()]; }
    /// Returns the fragment that carries a living cell of the material.
    ElementId fragment_of_cell(CellId cell) const { return fragment_of_cell_[cell.index()]; }
    /// Returns the cells that a living fragment carries, in ascending order.
    /// @lifetime Until the next edit.
    ListOrOne<CellId> cells_of(ElementId e) const {
        return ids_of(cells_of_fragment_, e, with_number_of<CellId>(e));
    }
    /// True if a cell belongs to the carrier of the fragment that carries it.
    bool is_at_home(CellId cell) const {
        return carrier(fragment_of_cell(cell)) == carrier_of_cell(cell);
    }
    /// True if a fragment of its own carrier carries the cell as one of a light part: by way of
    /// other carriers, around a cut. Such a part gives the fragment no connections at nodes.
    bool is_carried_around(CellId cell) const { return carried_around_.contains(cell); }
    /// True if the cell belongs to the part of its carrier that its fragment is the element of.
    bool is_own(CellId cell) const { return is_at_home(cell) && !is_carried_around(cell); }
    /// Returns the combination of nodes that a living node of the material follows. Of the
    /// fragments at the node it is in the lowest one that has cells of its own carrier there, or
    /// else in the lowest one.
    EmbeddedPoint embedded(const topology::Mesh& material, VertexId v) const;
    /// Returns the combination of the corners of a fragment that is at `x` at rest, m.
    EmbeddedPoint embedded(ElementId e, const Vec3& x) const;
    /// Returns the weights of the corners of a carrier, in their order, for a point at `x` at rest,
    /// m. In a carrier that is no tetrahedron see weights_in_cell().
    std::array<double, topology::max_corners> weights_in_carrier(CarrierId carrier,
                                                                 const Vec3& x) const;
    /// Returns the origins of the corners of a carrier, in their order; see origin().
    CornerNodes origins_of(CarrierId carrier) const;

    bool operator==(const FragmentMesh&) const = default;

  private:
    friend class FragmentArchive;
    friend class FragmentParts;
    friend class FragmentUpdate;

    FragmentMesh(double light_share, topology::FollowedEpoch epoch)
        : light_share_(light_share), epoch_(epoch) {}
    std::vector<NodeId> add_nodes(const topology::Mesh& material);
    /// Computes what follows from the lists of carriers and nodes.
    void complete();
    /// True if the element was dead before any cut, or was only a part of another carrier: then it
    /// is no carrier, though it has the id of one.
    bool was_never_alive(CarrierId carrier) const {
        const auto first = with_number_of<ElementId>(carrier);
        return carrier_of_cell_[carrier.index()] != carrier ||
               (!is_alive(first) && fragment_of_cell_[carrier.index()] == first);
    }

    /// Follows the nodes that an edit of the material adds: see is_constrained().
    void constrain_new_nodes(const topology::ChangeSet& changes);
    void truncate(std::size_t num_nodes, std::size_t num_elements, std::size_t num_cells);
    /// Moves a cell from the list of one fragment to that of another; either may be invalid.
    void move_cell(CellId cell, ElementId from, ElementId to);
    void set_share(ElementId e, double share) {
        if (share == 1.0)
            shares_.erase(e);
        else
            shares_[e] = share;
    }
    void set_carried_around(CellId cell, bool is_around) {
        if (is_around)
            carried_around_.insert(cell);
        else
            carried_around_.erase(cell);
    }
    /// Computes the shares of the tetrahedra of the living fragments of a carrier. They depend only
    /// on its cells. Those of a divided carrier are its volume shares, too.
    struct PartSharesUpdate {
        std::vector<ElementId> changed;  ///< fragments of which they have changed
        bool has_overlaps = false;       ///< true if parts reach into each other
    };
    PartSharesUpdate update_part_shares(const topology::Mesh& material, CarrierId carrier);
    /// Sets the living fragments of a carrier, in ascending order.
    void set_fragments(CarrierId carrier, std::vector<ElementId> fragments);
    // Lists of which an absent entry means the one id with the number of the key.
    template <class Key, class Id>
    using Lists = std::unordered_map<Key, std::vector<Id>>;
    template <class Key, class Id>
    static ListOrOne<Id> ids_of(const Lists<Key, Id>& lists, Key key, Id one) {
        const auto it = lists.find(key);
        return it == lists.end() ? ListOrOne<Id>(one) : ListOrOne<Id>(it->second);
    }
    /// Returns the entry of a key, which is made if it was absent.
    template <class Key, class Id>
    static std::vector<Id>& entry_of(Lists<Key, Id>& lists, Key key) {
        return lists.try_emplace(key, 1, with_number_of<Id>(key)).first->second;
    }
    /// Drops the entry of a key if it has become what an absent entry means.
    template <class Key, class Id>
    static void drop_if_trivial(Lists<Key, Id>& lists, Key key) {
        const auto it = lists.find(key);
        if (it != lists.end() && it->second == std::vector{with_number_of<Id>(key)})
            lists.erase(it);
    }
    /// True if star() is not empty.
    bool has_element_at(NodeId n) const;
    ListOrOne<ElementId> fragments_of(CarrierId carrier) const {
        const auto first = with_number_of<ElementId>(carrier);
        return ids_of(fragments_of_carrier_, carrier, is_alive(first) ? first : ElementId());
    }
    ListOrOne<CellId> cells_of_carrier(CarrierId carrier) const {
        return ids_of(cells_of_carrier_, carrier, with_number_of<CellId>(carrier));
    }
    int region_of_carrier(CarrierId carrier) const { return regions_[carrier.index()]; }
    /// Returns the volume of a carrier at rest, m3.
    double volume_of(CarrierId carrier) const { return volumes_[carrier.index()]; }
    std::span<const CarrierId> carriers_at(NodeId origin) const;

    double light_share_;
    topology::FollowedEpoch epoch_;
    std::size_t num_nodes_ = 0, num_elements_ = 0;
    std::size_t num_origins_ = 0;  // the nodes before any cut are those with lower ids

    // By carrier, that is by id of an element before any cut. These never change.
    std::vector<topology::CellKind> kinds_;
    std::vector<topology::Diagonals> diagonals_;  // empty if there are none
    std::vector<int> regions_;
    std::vector<double> volumes_;  // at rest, m3
    // By node before any cut: the carriers at it, in ascending order.
    std::vector<std::uint32_t> carrier_begin_;
    std::vector<CarrierId> carriers_at_;

    // By fragment. The first ones are those of the carriers with their numbers, and keep their
    // corners, or copies of them: the origins of these are those of the carrier.
    std::vector<CarrierId> carriers_of_added_;  // of the later ones
    std::vector<std::uint8_t> is_alive_;
    std::unordered_map<ElementId, double> shares_;                    // those that are not 1
    std::unordered_map<ElementId, std::vector<double>> part_shares_;  // see part_shares()
    std::vector<std::uint32_t> corner_begin_{0};
    std::vector<NodeId> corners_;
    // By node.
    // The node before any cut that it is, or is a copy of. Of several nodes with the same rest
    // position, which an edit may join, it is the lowest.
    std::vector<NodeId> origins_;
    std::vector<Vec3> rest_positions_;
    std::vector<std::uint8_t> is_node_alive_;
    // By cell of the material.
    std::vector<CarrierId> carrier_of_cell_;
    std::vector<ElementId> fragment_of_cell_;
    std::unordered_set<CellId> carried_around_;
    std::vector<std::uint8_t> is_constrained_;  // by node of the material, also if it is dead
    /// Scratch of FragmentParts from the first edit on, -1 between edits.
    struct Scratch {
        std::vector<std::int32_t> part_of_cell, first_part;  // by cell; by carrier
        bool operator==(const Scratch&) const { return true; }
    };
    Scratch scratch_;

    // Exceptions: a carrier that is not listed has one cell and one fragment, of its own number.
    Lists<CarrierId, CellId> cells_of_carrier_;
    Lists<CarrierId, ElementId> fragments_of_carrier_;
    Lists<ElementId, CellId> cells_of_fragment_;
};

}  // namespace incise::fragments
