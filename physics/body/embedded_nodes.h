// Where the nodes of the mesh are in a body whose elements are fragments.
// Source: docs/theory.md, Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/physics/body/force_term.h"
#include "incise/physics/elements/state.h"
#include "incise/topology/fragment_mesh.h"
#include "incise/topology/mesh.h"

namespace incise::physics {

/// The nodes of a mesh as combinations of the nodes of its fragments. Positions and velocities are
/// computed when they are asked for, once for each state.
/// @thread One thread at a time.
class EmbeddedNodes {
  public:
    /// Cost: O(n).
    EmbeddedNodes(const topology::Mesh& mesh, const topology::FragmentMesh& fragments);

    /// Follows an edit. Cost: proportional to the touched nodes.
    void apply(const topology::Mesh& mesh, const topology::FragmentMesh& fragments,
               const BodyEdit& edit, const topology::FragmentChanges& changes);

    /// Returns the combination that a living node follows.
    const topology::Embedding& operator[](VertexId n) const { return of_node_[n.index()]; }
    /// True if each node of the mesh is the node of the fragments with the same id, as before any
    /// division. Positions and velocities are then those of the state.
    bool is_trivial() const { return num_embedded_ == 0; }
    /// Returns a bound on how far a node of the mesh moves for each metre that the nodes of the
    /// fragments move: the largest sum of the absolute values of its weights.
    double largest_gain() const { return gains_.empty() ? 1.0 : *gains_.rbegin(); }

    /// Returns the values of all nodes of the mesh, by id, from those of the nodes of the
    /// fragments. Dead nodes have zero.
    std::span<const Vec3> positions(const State& state) const {
        return interpolated(state, state.positions(), positions_);
    }
    std::span<const Vec3> velocities(const State& state) const {
        return interpolated(state, state.velocities(), velocities_);
    }

  private:
    struct Values {
        std::uint64_t version = 0;  // of the state; 0: not known
        std::vector<Vec3> values;
    };
    void set(VertexId n, const topology::Embedding& at);
    void find(const topology::Mesh& mesh, const topology::FragmentMesh& fragments, VertexId n);
    bool is_embedded(std::size_t n) const {
        const topology::Embedding& at = of_node_[n];
        return at.count > 1 || (at.count == 1 && at.nodes[0] != NodeId(n));
    }
    std::span<const Vec3> interpolated(const State& state, std::span<const Vec3> of_fragments,
                                       Values& known) const;

    std::vector<topology::Embedding> of_node_;
    std::size_t num_embedded_ = 0;  // nodes that are not the node with the same id
    std::multiset<double> gains_;   // of the present nodes, those above 1
    mutable Values positions_, velocities_;
};

}  // namespace incise::physics
