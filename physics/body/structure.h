// What a body is made of: elements and lumped masses at nodes. It follows the edits of its mesh.
// Source: HEML 2015, section 3; docs/theory.md, Masses and time steps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "incise/fragments/embedding.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/physics/body/body_edit.h"
#include "incise/physics/elements/element_store.h"
#include "incise/physics/elements/stable_step.h"
#include "incise/physics/elements/state.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// Elements, masses and stiffness of a body: what edits change and motion does not.
///
/// The mesh is the material. The elements are its fragments (fragments::FragmentMesh): a cut
/// divides the material exactly, and the fragments of an element move as the whole would. Without
/// cuts, elements and nodes are those of the mesh, with the same ids. Arrays are by node of the
/// fragments, unless they are said to be by node of the mesh. Dead nodes have no mass.
class Structure {
  public:
    /// Sums the masses of all nodes. Throws InputError as ElementStore does.
    /// @param fragments  of the mesh; the fibres of the table are by id of fragments
    /// @lifetime The mesh must outlive the structure.
    Structure(const topology::Mesh& mesh, fragments::FragmentMesh fragments,
              const MaterialTable& table);

    const topology::Mesh& mesh() const { return mesh_; }
    const fragments::FragmentMesh& fragments() const { return fragments_; }
    const fragments::Embedding& embedding() const { return embedding_; }
    const ElementStore& elements() const { return elements_; }
    std::span<const double> masses() const { return masses_; }  ///< lumped, kg
    double size() const { return size_; }  ///< diagonal of the box around the rest mesh, m
    /// Returns a number that changes with each edit, also with each undo of an edit, and when
    /// materials change: see Model::version().
    std::uint64_t version() const { return version_; }

    /// Returns the mass of the material at each node of the mesh, kg. A cell that is whole and has
    /// the corners of its element gives each corner what the element does. A part of a cell, and a
    /// whole polyhedron beside a cut, gives each of its corners an equal part. Cost: O(n).
    std::vector<double> mesh_masses() const;
    /// Returns the density of the material of a region, kg/m3.
    double density(int region) const { return elements_.density(region); }
    /// Returns the direction of the fibres at rest, by fragment. It is zero where there are none.
    /// Empty if no material has fibres.
    std::span<const Vec3> fibres() const { return elements_.fibres(); }
    /// Returns the sum of modulus times rest volume over the elements, J. This is the order of the
    /// elastic energy at a strain of one. Rounding errors of the elastic energy are small against
    /// it.
    double stiffness_energy() const;

    /// Returns the bound on explicit steps at rest, s; see StableStep. The bound ignores damping,
    /// which only increases the stable step.
    double rest_stable_step() const { return stable_step_.value(); }
    /// Returns the bound on explicit steps in a state, s; see Model::stable_step().
    double stable_step(const State& state, const Workers& workers) const;
    /// Returns the same bound if only the given nodes counted, s. Dead nodes do not count.
    /// Cost: proportional to the stars of the nodes.
    double stable_step(const State& state, std::span<const NodeId> nodes) const;
    /// Returns the bound on the stiffness of a living node at rest, N/m, from which the stable step
    /// is computed.
    double stiffness_bound(std::size_t node) const {
        return stable_step_.quotient(node) * masses_[node];
    }
    /// Returns the stable step of one fragment if its nodes had no other one, s.
    double element_stable_step(ElementId e) const;
    /// Returns a cell of the mesh at the node that sets the stable step.
    CellId limiting_cell() const {
        const NodeId n(stable_step_.limiting_node());
        return fragments_.cells_of(fragments_.incident_element(n)).front();
    }

    /// Returns what followers of an edit may read, with the positions of a state.
    BodyView view(const State& state) const {
        return {mesh_, fragments_, elements_, masses_, state.positions()};
    }

  private:
    friend class Model;
    friend class Boundary;

    /// Sums mass and stiffness of a node. `outer_stiffness` is that of the force terms, N/m.
    void gather(NodeId n, double outer_stiffness);
    /// Follows an edit that the fragments have followed, but for the sums of its nodes and the
    /// embedding.
    void follow(const fragments::FragmentChanges& changes);
    void resize(std::size_t num_nodes);

    const topology::Mesh& mesh_;
    fragments::FragmentMesh fragments_;
    ElementStore elements_;
    fragments::Embedding embedding_;
    double size_;
    std::vector<double> masses_;
    StableStep stable_step_;
    std::uint64_t version_ = 0;
    std::vector<ElementId> star_;                    // scratch
    mutable std::vector<double> highest_of_ranges_;  // scratch of stable_step(), by range of nodes
};

}  // namespace incise::physics
