// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/embedding.h"

#include <algorithm>
#include <cmath>

namespace incise::fragments {

using topology::Mesh;

Embedding::Embedding(const Mesh& mesh, const FragmentMesh& fragments)
    : node_of_vertex_(mesh.node_capacity()) {
    for (const VertexId v : mesh.nodes()) find(mesh, fragments, v);
}

namespace {

/// Returns how far a point moves at most for each metre that its nodes move.
double gain(const EmbeddedPoint& at) {
    double sum = 0.0;
    at.for_each([&](NodeId, double weight) { sum += std::abs(weight); });
    constexpr double rounding = 1e-12;  // of weights that sum to 1
    return sum > 1.0 + rounding ? sum : 1.0;
}

}  // namespace

void Embedding::set(VertexId v, const EmbeddedPoint& at) {
    num_embedded_ -= is_embedded(v) ? 1 : 0;
    if (combinations_.contains(v))
        if (const double before = gain(combinations_.at(v)); before > 1.0)
            gains_.erase(gains_.find(before));
    node_of_vertex_[v.index()] = at.count == 1 ? at.nodes[0] : NodeId();
    if (at.count > 1)
        combinations_[v] = at;
    else
        combinations_.erase(v);
    if (const double now = gain(at); now > 1.0) gains_.insert(now);
    num_embedded_ += is_embedded(v) ? 1 : 0;
}

void Embedding::find(const Mesh& mesh, const FragmentMesh& fragments, VertexId v) {
    set(v, mesh.is_alive(v) ? fragments.embedded(mesh, v) : EmbeddedPoint());
}

void Embedding::apply(const Mesh& mesh, const FragmentMesh& fragments,
                      std::span<const VertexId> touched_of_mesh, const FragmentChanges& changes) {
    positions_.version = velocities_.version = 0;
    for (std::size_t v = mesh.node_capacity(); v < node_of_vertex_.size(); ++v)
        set(VertexId(v), {});
    node_of_vertex_.resize(mesh.node_capacity());
    std::vector<VertexId> touched(touched_of_mesh.begin(), touched_of_mesh.end());
    const auto touch = [&](CellId cell) {
        const auto corners = mesh.corners(cell);
        touched.insert(touched.end(), corners.begin(), corners.end());
    };
    // A vertex follows another fragment, or the same one with other corners.
    for (const CarriedCell& cell : changes.cells)
        if (cell.cell.index() < mesh.element_capacity() && mesh.is_alive(cell.cell))
            touch(cell.cell);
    for (const ElementRewiring& rewiring : changes.mesh.rewired)
        if (fragments.is_alive(rewiring.element))
            for (const CellId cell : fragments.cells_of(rewiring.element)) touch(cell);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const VertexId v : touched)
        if (v.index() < node_of_vertex_.size()) find(mesh, fragments, v);
}

std::span<const Vec3> Embedding::interpolated(std::span<const Vec3> of_nodes, std::uint64_t version,
                                              Values& known) const {
    if (is_trivial()) return of_nodes;
    if (known.version == version) return known.values;
    known.version = version;
    known.values.resize(node_of_vertex_.size());
    for (std::size_t v = 0; v < node_of_vertex_.size(); ++v) {
        const NodeId n = node_of_vertex_[v];
        known.values[v] = n.is_valid() ? of_nodes[n.index()] : Vec3(Vec3::Zero());
    }
    combinations_.for_each(
        [&](VertexId v, const EmbeddedPoint& at) { known.values[v.index()] = at.value(of_nodes); });
    return known.values;
}

}  // namespace incise::fragments
