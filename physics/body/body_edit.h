// An edit of a body as a value, and what those who follow it may read.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/fragments/fragment_changes.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/elements/element_store.h"
#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// A view of a body: its mesh, and what its nodes have.
///
/// Forces act on the nodes of the physics: these have masses and positions of their own. The
/// vertices of the mesh follow them; FragmentMesh::embedded() gives their weights. Before the first
/// cut, both have the same numbers.
struct BodyView {
    const topology::Mesh& mesh;
    const fragments::FragmentMesh& fragments;
    const ElementStore& elements;
    std::span<const double> masses;  ///< lumped, kg, by node of the fragments
    /// Of the last step, m, by node of the fragments. A solver may ask for forces at others.
    std::span<const Vec3> positions;

    /// Returns the mass of an element of the mesh at one of its corners, kg. A part of an element,
    /// and one whose faces have other corners than its fragment, has the same at each corner.
    double mass_at_corner(CellId cell, std::size_t corner) const {
        const ElementId e = fragments.fragment_of_cell(cell);
        if (fragments.cells_of(e).size() == 1 && fragments.volume_share(e) == 1.0)
            if (const auto of_element = corner_of_element(cell, corner))
                return elements.block_of(fragments, e).contributions(e).mass[*of_element];
        return elements.density(mesh.region(cell)) * topology::rest_volume(mesh, cell) /
               static_cast<double>(mesh.corners(cell).size());
    }

  private:
    /// Returns the number that a corner of a whole cell has in its element.
    std::optional<std::size_t> corner_of_element(CellId cell, std::size_t corner) const {
        if (!mesh.is_polyhedron(cell)) return corner;
        const auto whole = mesh.whole_cell(cell);
        if (!whole) return std::nullopt;
        const auto corners = whole->corners();
        return static_cast<std::size_t>(std::ranges::find(corners, mesh.corners(cell)[corner]) -
                                        corners.begin());
    }
};

/// What one edit did to a body: to its mesh, to its fragments, and to what they carry. A value,
/// which can be kept, and applied in both directions: see Model::apply() and inverse().
struct BodyEdit {
    /// The velocity of a node that keeps the momenta after light fragments joined others.
    struct Velocity {
        NodeId node;
        Vec3 before = Vec3::Zero(), after = Vec3::Zero();  ///< m/s
        bool operator==(const Velocity&) const = default;
    };

    topology::ChangeSet material;
    fragments::FragmentChanges physics;
    std::vector<Velocity> velocities;
    /// The vertices at cells that it has changed, in ascending order; also some that it removed.
    std::vector<VertexId> touched_vertices;
    /// The nodes whose mass or stiffness it may have changed, in ascending order; also some that it
    /// removed.
    std::vector<NodeId> touched_nodes;

    bool is_empty() const { return material.is_empty(); }
    /// True if it takes another edit back.
    bool goes_back() const { return material.epoch_after < material.epoch_before; }
    bool operator==(const BodyEdit&) const = default;
};

/// Returns the edit that takes `edit` back.
BodyEdit inverse(BodyEdit edit);

/// A type that keeps values of a body and follows its edits. apply(body, edit) is called for each
/// edit, in order, with the body after it. For what keeps values of the mesh alone, see
/// topology::Follower.
template <class T>
concept BodyFollower = requires(T& follower, const BodyView& body, const BodyEdit& edit) {
    follower.apply(body, edit);
};

}  // namespace incise::physics
