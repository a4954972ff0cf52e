// How the vertices of the material follow the nodes of the physics.
// Source: docs/theory.md, Fragments.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/fragments/embedded_point.h"
#include "incise/fragments/fragment_changes.h"
#include "incise/fragments/fragment_mesh.h"
#include "incise/topology/cell_point.h"
#include "incise/topology/id_map.h"
#include "incise/topology/mesh.h"

namespace incise::fragments {

/// The vertices of a mesh as combinations of the nodes of its fragments. Positions and velocities
/// are computed when they are asked for, once for each state. Forces and impulses on points of the
/// material go the other way, with the same weights: see EmbeddedPoint::for_each().
/// @thread One thread at a time.
class Embedding {
  public:
    /// Cost: O(n).
    Embedding(const topology::Mesh& mesh, const FragmentMesh& fragments);

    /// Follows an edit. Cost: proportional to the touched vertices.
    /// @param mesh       after the edit
    /// @param fragments  after the edit
    /// @param touched    the vertices of the mesh at cells that have changed
    /// @param changes    what the edit changed in the fragments
    void apply(const topology::Mesh& mesh, const FragmentMesh& fragments,
               std::span<const VertexId> touched, const FragmentChanges& changes);

    /// Calls visit(node, weight) for each node that a living vertex follows: see EmbeddedPoint.
    template <class Visit>
    void for_each(VertexId v, Visit visit) const {
        if (node_of_vertex_[v.index()].is_valid())
            visit(node_of_vertex_[v.index()], 1.0);
        else if (combinations_.contains(v))
            combinations_.at(v).for_each(visit);
    }
    /// Calls visit(node, weight) for the nodes that a point in a cell follows; for some of them
    /// more than once.
    template <class Visit>
    void for_each(const topology::CellPoint& at, Visit visit) const {
        at.for_each([&](VertexId v, double of_vertex) {
            for_each(v, [&](NodeId n, double weight) { visit(n, of_vertex * weight); });
        });
    }
    /// True if each vertex is the node with the same number, as before any division. Positions and
    /// velocities are then those of the nodes.
    bool is_trivial() const { return num_embedded_ == 0; }
    /// Returns a bound on how far a vertex moves for each metre that the nodes move: the largest
    /// sum of the absolute values of its weights.
    double largest_gain() const { return gains_.empty() ? 1.0 : *gains_.rbegin(); }

    /// Returns the positions, or the velocities, of all vertices, by id. Dead ones have zero.
    /// @param of_nodes  by node id
    /// @param version   of the state that these belong to, above 0
    std::span<const Vec3> positions(std::span<const Vec3> of_nodes, std::uint64_t version) const {
        return interpolated(of_nodes, version, positions_);
    }
    std::span<const Vec3> velocities(std::span<const Vec3> of_nodes, std::uint64_t version) const {
        return interpolated(of_nodes, version, velocities_);
    }

  private:
    struct Values {
        std::uint64_t version = 0;  // of the state; 0: not known
        std::vector<Vec3> values;
    };
    void set(VertexId v, const EmbeddedPoint& at);
    void find(const topology::Mesh& mesh, const FragmentMesh& fragments, VertexId v);
    bool is_embedded(VertexId v) const {
        const NodeId n = node_of_vertex_[v.index()];
        return n.is_valid() ? n != with_number_of<NodeId>(v) : combinations_.contains(v);
    }
    std::span<const Vec3> interpolated(std::span<const Vec3> of_nodes, std::uint64_t version,
                                       Values& known) const;

    std::vector<NodeId> node_of_vertex_;  // of a vertex that follows one node, else invalid
    topology::IdMap<VertexId, EmbeddedPoint> combinations_;  // of those that follow several
    std::size_t num_embedded_ = 0;  // vertices that are not the node with the same number
    std::multiset<double> gains_;   // of the present vertices, those above 1
    mutable Values positions_, velocities_;
};

}  // namespace incise::fragments
