// The changes that one edit made to a mesh, as a value that can be compared, printed and inverted.
// Replay, undo, logs, checkpoints and followers of the mesh need nothing else.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/cell_shape.h"

namespace incise::topology {

/// A node that an edit added or removed: of the material a vertex, of the physics a node. The
/// sources tell where its values come from:
/// - added, one source: the copy of a node that was divided
/// - added, several sources: a point between other nodes
/// - added, no source: a node that an undo brings back, with the values that it had when removed
/// - removed, one source: a node that was merged into its source
/// - removed, no source: a node whose last element was removed
template <class Node>
struct NodeRecordOf {
    /// A term of a convex combination of nodes.
    struct Source {
        Node node;
        double weight = 0.0;
        bool operator==(const Source&) const = default;
        static void archive(auto& ar, auto& self) { ar(self.node, self.weight); }
    };
    Node id;
    Vec3 rest_position = Vec3::Zero();
    std::array<Source, max_corners> sources{};
    int num_sources = 0;
    bool operator==(const NodeRecordOf&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.id, self.rest_position, self.sources, self.num_sources);
    }
};

/// An element that an edit added or removed: of the material a cell, of the physics an element. The
/// corners are those after the edit for an added element, and those before it for a removed one.
template <class Node, class Element>
struct ElementRecordOf {
    Element id;
    CellKind kind{};
    int region = 0;
    Element parent;  ///< the element that it was divided from; invalid if there is none
    std::vector<Node> corners;
    bool operator==(const ElementRecordOf&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.id, self.kind, self.region, self.parent, self.corners);
    }
};

/// A corner of a living element at which an edit replaced the node.
template <class Node, class Element>
struct RewiringOf {
    Element element;
    int corner = 0;
    Node from, to;
    bool operator==(const RewiringOf&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.element, self.corner, self.from, self.to); }
};

/// What one edit did to the nodes and elements of a mesh. All lists are in ascending order of their
/// ids.
template <class NodeOf, class ElementOf>
struct MeshChanges {
    using Node = NodeOf;
    using Element = ElementOf;
    using NodeRecord = NodeRecordOf<Node>;
    using ElementRecord = ElementRecordOf<Node, Element>;
    using Rewiring = RewiringOf<Node, Element>;

    std::uint64_t epoch_before = 0, epoch_after = 0;
    std::size_t node_capacity_before = 0, node_capacity_after = 0;
    std::size_t element_capacity_before = 0, element_capacity_after = 0;

    std::vector<NodeRecord> nodes_added, nodes_removed;
    std::vector<ElementRecord> elements_added, elements_removed;
    std::vector<Rewiring> rewired;

    /// True if nothing was edited. The record of an edit can have empty lists, but it leads to
    /// another epoch.
    bool is_empty() const {
        return epoch_before == epoch_after && nodes_added.empty() && nodes_removed.empty() &&
               elements_added.empty() && elements_removed.empty() && rewired.empty();
    }
    bool operator==(const MeshChanges&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.epoch_before, self.epoch_after, self.node_capacity_before, self.node_capacity_after,
           self.element_capacity_before, self.element_capacity_after, self.nodes_added,
           self.nodes_removed, self.elements_added, self.elements_removed, self.rewired);
    }
};

using VertexRecord = NodeRecordOf<VertexId>;
using CellRecord = ElementRecordOf<VertexId, CellId>;
using CellRewiring = RewiringOf<VertexId, CellId>;

/// A change of Mesh::was_inside() at the faces of a cell that is no polyhedron: bit f for face f.
/// From 0 for a cell that the edit added.
struct InsideChange {
    CellId cell;
    std::uint8_t from = 0, to = 0;
    bool operator==(const InsideChange&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.cell, self.from, self.to); }
};

/// The two sides of a face, the one with the lower id first.
struct FacePair {
    FaceId a, b;
    auto operator<=>(const FacePair&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.a, self.b); }
};

/// A change of the faces of a cell that is a polyhedron before or after the edit. The shape of
/// another kind is empty here: it is in the corners of the cell. From an empty polyhedron for a
/// cell that the edit added.
struct ShapeChange {
    CellId cell;
    CellKind kind_from = CellKind::polyhedron, kind_to = CellKind::polyhedron;
    CellShape from, to;
    bool operator==(const ShapeChange&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.cell, self.kind_from, self.kind_to, self.from, self.to);
    }
};

/// The record of one edit of the material. The opened faces include the shared faces of removed
/// cells. Faces are named by the numbers that they have where they are joined: those opened by the
/// numbers before the edit, those closed by the numbers after it. A face of a polyhedron that gets
/// another number is in both lists.
struct ChangeSet : MeshChanges<VertexId, CellId> {
    std::vector<ShapeChange> shape_changes;  ///< in ascending order of cells
    std::vector<InsideChange> inside_changes;
    std::vector<FacePair> faces_opened, faces_closed;

    /// See MeshChanges::is_empty().
    bool is_empty() const;
    bool operator==(const ChangeSet&) const = default;
    static void archive(auto& ar, auto& self) {
        MeshChanges::archive(ar, self);
        ar(self.shape_changes, self.inside_changes, self.faces_opened, self.faces_closed);
    }
};

/// Swaps before and after.
template <class Node, class Element>
void invert(MeshChanges<Node, Element>& changes) {
    std::swap(changes.epoch_before, changes.epoch_after);
    std::swap(changes.node_capacity_before, changes.node_capacity_after);
    std::swap(changes.element_capacity_before, changes.element_capacity_after);
    std::swap(changes.nodes_added, changes.nodes_removed);
    std::swap(changes.elements_added, changes.elements_removed);
    for (auto& rewiring : changes.rewired) std::swap(rewiring.from, rewiring.to);
}

/// Returns the edit that undoes `changes`.
ChangeSet inverse(const ChangeSet& changes);

class Mesh;
/// Returns the volume at rest of a cell that an edit added or removed, m3, with the corners of the
/// record.
/// @param mesh  at the end of the edit, with the nodes of the record, also dead ones
double rest_volume(const Mesh& mesh, const ChangeSet& changes, const CellRecord& record);

/// Returns the cells, dead ones included, that an edit added, removed, joined or parted, or of
/// which it changed a corner or a face; in ascending order.
std::vector<CellId> touched_cells(const ChangeSet& changes);

}  // namespace incise::topology
