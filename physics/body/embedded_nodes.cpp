// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/embedded_nodes.h"

#include <algorithm>
#include <cmath>

namespace incise::physics {

using topology::FragmentMesh;
using topology::Mesh;

EmbeddedNodes::EmbeddedNodes(const Mesh& mesh, const FragmentMesh& fragments)
    : of_node_(mesh.node_capacity()) {
    for (const VertexId n : mesh.nodes()) find(mesh, fragments, n);
}

namespace {

/// Returns how far a point moves at most for each metre that its nodes move.
double gain(const topology::Embedding& at) {
    double sum = 0.0;
    for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k)
        sum += std::abs(at.weights[k]);
    constexpr double rounding = 1e-12;  // of weights that sum to 1
    return sum > 1.0 + rounding ? sum : 1.0;
}

}  // namespace

void EmbeddedNodes::set(VertexId n, const topology::Embedding& at) {
    topology::Embedding& known = of_node_[n.index()];
    num_embedded_ -= is_embedded(n.index()) ? 1 : 0;
    if (const double before = gain(known); before > 1.0) gains_.erase(gains_.find(before));
    known = at;
    if (const double now = gain(known); now > 1.0) gains_.insert(now);
    num_embedded_ += is_embedded(n.index()) ? 1 : 0;
}

void EmbeddedNodes::find(const Mesh& mesh, const FragmentMesh& fragments, VertexId n) {
    set(n, mesh.is_alive(n) ? fragments.embedding(mesh, n) : topology::Embedding());
}

void EmbeddedNodes::apply(const Mesh& mesh, const FragmentMesh& fragments, const BodyEdit& edit,
                          const topology::FragmentChanges& changes) {
    positions_.version = velocities_.version = 0;
    for (std::size_t n = mesh.node_capacity(); n < of_node_.size(); ++n) set(VertexId(n), {});
    of_node_.resize(mesh.node_capacity());
    std::vector<VertexId> touched(edit.touched_of_mesh.begin(), edit.touched_of_mesh.end());
    const auto touch = [&](CellId cell) {
        const auto corners = mesh.corners(cell);
        touched.insert(touched.end(), corners.begin(), corners.end());
    };
    // A node follows another fragment, or the same one with other corners.
    for (const topology::CarriedCell& cell : changes.cells)
        if (cell.cell.index() < mesh.element_capacity() && mesh.is_alive(cell.cell))
            touch(cell.cell);
    for (const topology::Rewiring& rewiring : changes.mesh.rewired)
        if (fragments.is_alive(rewiring.element))
            for (const CellId cell : fragments.cells_of(rewiring.element)) touch(cell);
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    for (const VertexId n : touched)
        if (n.index() < of_node_.size()) find(mesh, fragments, n);
}

std::span<const Vec3> EmbeddedNodes::interpolated(const State& state,
                                                  std::span<const Vec3> of_fragments,
                                                  Values& known) const {
    if (is_trivial()) return of_fragments;
    if (known.version == state.version()) return known.values;
    known.version = state.version();
    known.values.assign(of_node_.size(), Vec3::Zero());
    for (std::size_t n = 0; n < of_node_.size(); ++n) {
        const topology::Embedding& at = of_node_[n];
        if (at.count == 1) {
            known.values[n] = of_fragments[at.nodes[0].index()];
            continue;
        }
        Vec3& x = known.values[n];
        for (std::size_t k = 0; k < static_cast<std::size_t>(at.count); ++k)
            x += at.weights[k] * of_fragments[at.nodes[k].index()];
    }
    return known.values;
}

}  // namespace incise::physics
