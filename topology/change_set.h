// What one edit did to a mesh, as a value: comparable, printable and invertible, so that replay,
// undo, logs, checkpoints and every follower of the mesh need neither the map nor its callbacks.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// Part of a convex combination.
struct NodeSource {
    NodeId node;
    double weight = 0.0;
    bool operator==(const NodeSource&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.node, self.weight); }
};

/// A node that an edit added or removed. Its values follow from those of its sources:
/// added, one source    the copy of a node that was divided
/// added, more sources  a point between others
/// added, no source     a node that comes back; its values are those it had when it went
/// removed, one source  a node merged into its source
/// removed, no source   a node whose last element went
struct NodeRecord {
    NodeId id;
    Vec3 rest_position = Vec3::Zero();
    std::array<NodeSource, 4> sources{};
    int num_sources = 0;
    bool operator==(const NodeRecord&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.id, self.rest_position, self.sources, self.num_sources);
    }
};

/// An element that an edit added or removed, with its corners after (added) or before (removed).
struct ElementRecord {
    ElementId id;
    CellKind kind{};
    int region = 0;
    ElementId parent;  ///< the element it was split from; invalid if none
    std::vector<NodeId> corners;
    bool operator==(const ElementRecord&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.id, self.kind, self.region, self.parent, self.corners);
    }
};

/// A corner of a living element that now is another node.
struct Rewiring {
    ElementId element;
    int corner = 0;
    NodeId from, to;
    bool operator==(const Rewiring&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.element, self.corner, self.from, self.to); }
};

/// The two sides of a face, the lower one first.
struct FacePair {
    FaceId a, b;
    auto operator<=>(const FacePair&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.a, self.b); }
};

/// All lists are in ascending order of their ids. Faces of removed elements that were shared are
/// among the opened ones.
struct ChangeSet {
    std::uint64_t epoch_before = 0, epoch_after = 0;
    std::size_t node_capacity_before = 0, node_capacity_after = 0;
    std::size_t element_capacity_before = 0, element_capacity_after = 0;

    std::vector<NodeRecord> nodes_added, nodes_removed;
    std::vector<ElementRecord> elements_added, elements_removed;
    std::vector<Rewiring> rewired;
    std::vector<FacePair> faces_opened, faces_closed;

    bool is_empty() const;
    bool operator==(const ChangeSet&) const = default;
    static void archive(auto& ar, auto& self) {
        ar(self.epoch_before, self.epoch_after, self.node_capacity_before, self.node_capacity_after,
           self.element_capacity_before, self.element_capacity_after, self.nodes_added,
           self.nodes_removed, self.elements_added, self.elements_removed, self.rewired,
           self.faces_opened, self.faces_closed);
    }
};

/// The edit that takes `changes` back.
ChangeSet inverse(const ChangeSet& changes);

}  // namespace incise::topology
