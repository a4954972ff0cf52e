// How a model follows edits of its mesh, and takes them back.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <map>
#include <numeric>

#include "incise/base/error.h"
#include "incise/physics/body/model.h"
#include "incise/topology/geometry.h"

namespace incise::physics {

using fragments::FragmentChanges;
using fragments::FragmentMesh;
using fragments::FragmentMeshChanges;
using topology::ChangeSet;
using topology::MeshChanges;

namespace {

template <class Id>
void make_sorted_set(std::vector<Id>& ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

/// Returns the nodes at elements that an edit has changed, in ascending order. `mesh` is a Mesh or
/// a FragmentMesh after the edit.
template <class Mesh, class Node, class Element>
std::vector<Node> touched_nodes(const Mesh& mesh, const MeshChanges<Node, Element>& changes) {
    std::vector<Node> touched;
    const auto touch = [&](std::span<const Node> nodes) {
        touched.insert(touched.end(), nodes.begin(), nodes.end());
    };
    const auto touch_all_of = [&](const auto& record) {
        touch(record.corners);
        // A division, or the undo of one, also changes the shape and mass of the parent.
        const Element parent = record.parent;
        if (parent.is_valid() && parent.index() < changes.element_capacity_after)
            touch(mesh.corners(parent));
    };
    for (const auto& record : changes.elements_removed) touch_all_of(record);
    for (const auto& record : changes.elements_added) touch_all_of(record);
    for (const auto& rewiring : changes.rewired) {
        touched.push_back(rewiring.from);
        touched.push_back(rewiring.to);
    }
    for (const auto& record : changes.nodes_removed) {
        touched.push_back(record.id);
        // A merge moves the survivor, even if its elements have been separated from it since.
        if (record.num_sources == 1) touched.push_back(record.sources[0].node);
    }
    make_sorted_set(touched);
    touched.erase(
        std::lower_bound(touched.begin(), touched.end(), Node(changes.node_capacity_after)),
        touched.end());
    return touched;
}

/// Returns the vertices at cells that an edit has changed, in ascending order.
std::vector<VertexId> touched_vertices(const topology::Mesh& mesh, const ChangeSet& changes) {
    std::vector<VertexId> touched = touched_nodes(mesh, changes);
    if (changes.shape_changes.empty()) return touched;
    for (const topology::ShapeChange& change : changes.shape_changes)
        if (change.cell.index() < mesh.element_capacity())
            std::ranges::copy(mesh.corners(change.cell), std::back_inserter(touched));
    make_sorted_set(touched);
    return touched;
}

/// Returns the nodes of the fragments whose mass or stiffness an edit may have changed, in
/// ascending order.
std::vector<NodeId> touched_nodes(const FragmentMesh& fragments, const FragmentChanges& changes) {
    std::vector<NodeId> touched = touched_nodes(fragments, changes.mesh);
    for (const fragments::ShareChange& change : changes.shares) {
        const auto corners = fragments.corners(change.fragment);
        touched.insert(touched.end(), corners.begin(), corners.end());
    }
    make_sorted_set(touched);
    return touched;
}

}  // namespace

BodyEdit Model::apply(const topology::Mesh& mesh, const ChangeSet& changes) {
    if (changes.is_empty()) return {changes, {}, {}, {}, {}};
    if (changes.epoch_after < changes.epoch_before)
        throw InputError("model: this edit takes back another one: apply the BodyEdit that does");
    topology::FollowedEpoch(fragments().epoch()).advance(mesh, changes, "model");
    const Momenta removed = momenta_of_removed(changes);
    BodyEdit edit{changes,
                  structure_.fragments_.apply(mesh, changes),
                  {},
                  touched_vertices(mesh, changes),
                  {}};
    edit.touched_nodes = touched_nodes(fragments(), edit.physics);
    const bool keeps_momenta = edit.physics.has_joins();
    const Momenta before = keeps_momenta ? momenta_of(edit.touched_nodes) - removed : Momenta();
    follow(edit);
    if (keeps_momenta)
        edit.velocities =
            change_momenta(edit.touched_nodes, before - momenta_of(edit.touched_nodes));
    return edit;
}

void Model::apply(const topology::Mesh& mesh, const BodyEdit& edit) {
    if (edit.is_empty()) return;
    if (!edit.goes_back()) {
        apply(mesh, edit.material);
        return;
    }
    structure_.fragments_.go_back(mesh, edit.physics);
    const auto velocities = state_.velocities();
    const bool has_moved = std::ranges::any_of(edit.velocities, [&](const auto& change) {
        return velocities[change.node.index()] != change.before;
    });
    if (!has_moved)
        for (const BodyEdit::Velocity& change : edit.velocities)
            state_.set_velocity(change.node, change.after);
    follow(edit);
}

void Model::follow(const BodyEdit& edit) {
    state_.apply(fragments(), edit.physics.mesh, masses());
    structure_.follow(edit.physics);
    for (const NodeId n : edit.touched_nodes) structure_.gather(n, boundary_.stiffness_bound(n));
    structure_.embedding_.apply(mesh(), fragments(), edit.touched_vertices, edit.physics);
    boundary_.apply(structure_.view(state_), edit);
    energetics_.forget(edit.touched_nodes);
    elastic_forces_.resize(masses().size(), Vec3::Zero());
}

/// Returns the momenta of nodes, about the origin.
Momenta Model::momenta_of(std::span<const NodeId> nodes) const {
    Momenta sum;
    for (const NodeId n : nodes)
        if (n.index() < masses().size() && masses()[n.index()] > 0.0)
            sum.add(masses()[n.index()], positions()[n.index()], velocities()[n.index()]);
    return sum;
}

/// Returns the momenta of the cells that an edit is about to remove from the model,
/// about the origin.
Momenta Model::momenta_of_removed(const ChangeSet& changes) const {
    std::map<CellId, double> volumes;  // removed, m3, by cell before the edit
    const auto volume_of = [&](const topology::CellRecord& record) {
        return topology::rest_volume(mesh(), changes, record);
    };
    for (const auto& record : changes.elements_removed) volumes[record.id] = volume_of(record);
    // Parts of an element that was divided before it was removed are still there.
    if (!volumes.empty()) {
        std::map<CellId, CellId> ancestors;
        topology::for_each_part(changes, [&](CellId parent, CellId part) {
            const auto known = ancestors.find(parent);
            ancestors[part] = known == ancestors.end() ? parent : known->second;
        });
        for (const auto& record : changes.elements_added)
            if (const auto ancestor = ancestors.find(record.id); ancestor != ancestors.end())
                if (const auto it = volumes.find(ancestor->second); it != volumes.end())
                    it->second -= volume_of(record);
    }
    Momenta sum;
    for (const auto& [cell, volume] : volumes) {
        const ElementId e = fragments().fragment_of_cell(cell);
        const auto corners = fragments().corners(e);
        const double mass = structure_.density(fragments().region(e)) * volume;
        const auto masses = structure_.elements().block_of(fragments(), e).contributions(e).mass;
        const double all = std::accumulate(masses.begin(), masses.end(), 0.0);
        const bool is_tetrahedron = corners.size() == 4;  // its corners have equal masses
        for (std::size_t k = 0; k < corners.size(); ++k)
            sum.add(is_tetrahedron ? mass / 4.0 : mass * masses[k] / all,
                    positions()[corners[k].index()], velocities()[corners[k].index()]);
    }
    return sum;
}

/// Changes the momenta of nodes by a rigid change of the velocities of those without constraint.
std::vector<BodyEdit::Velocity> Model::change_momenta(std::span<const NodeId> nodes,
                                                      const Momenta& by) {
    std::vector<BodyEdit::Velocity> changes;
    if (by.linear.isZero(0.0) && by.angular.isZero(0.0)) return changes;
    std::vector<MassPoint> points;
    for (const NodeId n : nodes) {
        if (masses()[n.index()] == 0.0 || boundary_.constraints().of_node(n.index())) continue;
        points.push_back({masses()[n.index()], positions()[n.index()]});
        changes.push_back({n, velocities()[n.index()], Vec3::Zero()});
    }
    const RigidVelocity change = rigid_change(points, by);
    for (std::size_t i = 0; i < changes.size(); ++i) {
        changes[i].after = changes[i].before + change.at(points[i].x);
        state_.set_velocity(changes[i].node, changes[i].after);
    }
    energetics_.forget(nodes);
    return changes;
}

}  // namespace incise::physics
