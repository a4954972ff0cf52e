// Fields of values at nodes and elements that follow the edits of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// Calls inherit(parent, part) for each element `part` that the edit divided off from `parent`. If
/// a parent is itself such a part, the call for it comes before the calls for its own parts.
/// Elements that an undo brings back are skipped, since they still have their values.
template <class Node, class Element, class Inherit>
void for_each_part(const MeshChanges<Node, Element>& changes, Inherit inherit) {
    for (const auto& record : changes.elements_added)  // in ascending order
        if (record.id.index() >= changes.element_capacity_before && record.parent.is_valid())
            inherit(record.parent, record.id);
}

/// One value for each node, by id: VertexId of the material, NodeId of the physics. T must have
/// sums and multiples. A copy of a node gets the value of that node. A node between others gets the
/// weighted mean of their values, with the weights of its record. Dead nodes keep their values, so
/// that an edit can be undone.
template <class Node, class T>
class NodeField {
  public:
    /// Gives every node the same value.
    NodeField(const EditedMesh auto& mesh, const T& value)
        : epoch_(mesh), values_(mesh.node_capacity(), value) {}
    /// @param values  by node id
    NodeField(const EditedMesh auto& mesh, std::span<const T> values)
        : epoch_(mesh), values_(values.begin(), values.end()) {}

    const T& operator[](Node n) const { return values_[n.index()]; }
    T& operator[](Node n) { return values_[n.index()]; }
    /// Returns the values by node id. Shape (node_capacity()).
    std::span<const T> values() const { return values_; }
    /// Replaces all values.
    /// @param values  by node id; as many as the field has
    void assign(std::span<const T> values) { values_.assign(values.begin(), values.end()); }

    /// Follows an edit. Only the record is read, so that several edits can be followed one after
    /// the other when the mesh has already been edited further.
    /// Throws InputError for an edit out of turn. Cost: proportional to the nodes added.
    template <class Element>
    void apply(const EditedMesh auto&, const MeshChanges<Node, Element>& changes) {
        if (changes.is_empty()) return;
        epoch_.advance(changes, "field of nodes");
        values_.resize(std::max(changes.node_capacity_before, changes.node_capacity_after));
        // In ascending order: a source may itself be new.
        for (const auto& record : changes.nodes_added) {
            if (record.num_sources == 0) continue;  // an undo brings it back, with its value
            T value = record.sources[0].weight * values_[record.sources[0].node.index()];
            for (std::size_t s = 1; s < static_cast<std::size_t>(record.num_sources); ++s)
                value += record.sources[s].weight * values_[record.sources[s].node.index()];
            values_[record.id.index()] = value;
        }
        values_.resize(changes.node_capacity_after);
    }

    /// Archives the values. A field that is read must be one of the same mesh.
    static void archive(auto& ar, auto& self) { ar(self.values_); }

  private:
    FollowedEpoch epoch_;
    std::vector<T> values_;
};

/// One value for each element, by id: CellId of the material, ElementId of the physics. Each part
/// of a divided element gets the value of that element. Dead elements keep their values, so that an
/// edit can be undone.
template <class Element, class T>
class ElementField {
  public:
    /// Gives every element the same value.
    ElementField(const EditedMesh auto& mesh, const T& value)
        : epoch_(mesh), values_(mesh.element_capacity(), value) {}
    /// @param values  by element id
    ElementField(const EditedMesh auto& mesh, std::vector<T> values)
        : epoch_(mesh), values_(std::move(values)) {}

    const T& operator[](Element e) const { return values_[e.index()]; }
    T& operator[](Element e) { return values_[e.index()]; }
    /// Returns the values by element id. Shape (element_capacity()).
    std::span<const T> values() const { return values_; }

    /// Follows an edit. Only the record is read, so that several edits can be followed one after
    /// the other when the mesh has already been edited further.
    /// Throws InputError for an edit out of turn. Cost: proportional to the elements added.
    template <class Node>
    void apply(const EditedMesh auto&, const MeshChanges<Node, Element>& changes) {
        if (changes.is_empty()) return;
        epoch_.advance(changes, "field of elements");
        values_.resize(std::max(changes.element_capacity_before, changes.element_capacity_after));
        for_each_part(changes, [&](Element parent, Element part) {
            values_[part.index()] = values_[parent.index()];
        });
        values_.resize(changes.element_capacity_after);
    }

  private:
    FollowedEpoch epoch_;
    std::vector<T> values_;
};

}  // namespace incise::topology
