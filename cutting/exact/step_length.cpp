// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/cutting/exact/step_length.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace incise::cutting {

namespace {

/// Six times the volume of a tetrahedron, and the inverse altitudes of its corners, 1/m.
struct Shape {
    double six_volumes;
    std::array<double, 4> inverse_altitudes;

    explicit Shape(const std::array<Vec3, 4>& x)
        : six_volumes(std::abs((x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])))) {
        for (std::size_t k = 0; k < 4; ++k) {
            const Vec3 &a = x[(k + 1) % 4], &b = x[(k + 2) % 4], &c = x[(k + 3) % 4];
            inverse_altitudes[k] = (b - a).cross(c - a).norm() / six_volumes;
        }
    }
    double sum() const {
        return inverse_altitudes[0] + inverse_altitudes[1] + inverse_altitudes[2] +
               inverse_altitudes[3];
    }
};

}  // namespace

double element_step_length(const std::array<Vec3, 4>& corners) {
    const Shape shape(corners);
    const double largest =
        *std::max_element(shape.inverse_altitudes.begin(), shape.inverse_altitudes.end());
    return 1.0 / std::sqrt(largest * shape.sum());
}

double step_length(const topology::Mesh& mesh) {
    // The step of a node is 2 / sqrt(s / m). Here s is the sum of V (1/h) sum_j (1/h_j) over its
    // elements, and m that of V / 4.
    std::vector<double> stiffness(mesh.node_capacity(), 0.0), volume(mesh.node_capacity(), 0.0);
    for (const ElementId e : mesh.elements()) {
        if (mesh.kind(e) != topology::CellKind::tetrahedron) continue;
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = mesh.rest_position(mesh.corners(e)[k]);
        const Shape shape(x);
        for (std::size_t k = 0; k < 4; ++k) {
            const std::size_t n = mesh.corners(e)[k].index();
            stiffness[n] += shape.six_volumes * shape.inverse_altitudes[k] * shape.sum();
            volume[n] += shape.six_volumes;
        }
    }
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t n = 0; n < volume.size(); ++n)
        if (volume[n] > 0.0) least = std::min(least, std::sqrt(volume[n] / stiffness[n]));
    return least;
}

double mean_edge_length(const topology::Mesh& mesh) {
    std::vector<std::pair<NodeId, NodeId>> edges;
    for (const ElementId e : mesh.elements()) {
        const topology::CellTraits& cell = traits(mesh.kind(e));
        const auto corners = mesh.corners(e);
        for (std::size_t k = 0; k < static_cast<std::size_t>(cell.num_edges); ++k)
            edges.push_back(std::minmax({corners[static_cast<std::size_t>(cell.edges[k][0])],
                                         corners[static_cast<std::size_t>(cell.edges[k][1])]}));
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    double sum = 0.0;
    for (const auto& [a, b] : edges) sum += (mesh.rest_position(b) - mesh.rest_position(a)).norm();
    return edges.empty() ? std::numeric_limits<double>::infinity()
                         : sum / static_cast<double>(edges.size());
}

UncutBody uncut_body(const topology::Mesh& mesh) {
    UncutBody body{mean_edge_length(mesh), {}};
    const double length = step_length(mesh);
    for (const ElementId e : mesh.elements()) body.step_length[mesh.region(e)] = length;
    return body;
}

}  // namespace incise::cutting
