// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_point.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "incise/topology/face_triangles.h"

namespace incise::topology {

namespace {

/// Returns the weights of the corners of a tetrahedron for a point of it near `x`; nothing if the
/// tetrahedron is flat.
std::optional<Eigen::Vector4d> weights_near(const std::array<Vec3, 4>& corners, const Vec3& x) {
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k)
        edges.col(k) = corners[static_cast<std::size_t>(k) + 1] - corners[0];
    if (edges.determinant() == 0.0) return std::nullopt;
    Eigen::Vector4d weights;
    weights.tail<3>() = edges.inverse() * (x - corners[0]);
    weights[0] = 1.0 - weights.tail<3>().sum();
    weights = weights.cwiseMax(0.0);
    weights /= weights.sum();
    if (!weights.allFinite()) return std::nullopt;
    return weights;
}

}  // namespace

CellPoint point_near(const Mesh& mesh, CellId cell, std::span<const Vec3> positions,
                     const Vec3& x) {
    const auto nodes = mesh.corners(cell);
    const auto at = [&](VertexId n) -> const Vec3& { return positions[n.index()]; };
    CellPoint found{cell};
    if (mesh.kind(cell) == CellKind::tetrahedron) {
        std::ranges::copy(nodes, found.corners.begin());
        found.count = 4;
        found.weights[0] = 1.0;
        if (const auto weights =
                weights_near({at(nodes[0]), at(nodes[1]), at(nodes[2]), at(nodes[3])}, x))
            for (std::size_t k = 0; k < 4; ++k) found.weights[k] = (*weights)[static_cast<int>(k)];
        return found;
    }
    const bool is_polyhedron = mesh.is_polyhedron(cell);
    Vec3 apex = at(nodes[0]);
    if (!is_polyhedron) {
        for (std::size_t k = 1; k < nodes.size(); ++k) apex += at(nodes[k]);
        apex /= static_cast<double>(nodes.size());
    }
    found.corners[0] = nodes[0];
    found.weights[0] = 1.0;
    found.count = 1;
    double least = std::numeric_limits<double>::infinity();
    const auto look_at = [&](VertexId a, VertexId b, VertexId c) {
        const std::array<Vec3, 4> tetrahedron = {apex, at(a), at(b), at(c)};
        const auto weights = weights_near(tetrahedron, x);
        if (!weights) return;
        Vec3 point = Vec3::Zero();
        for (std::size_t i = 0; i < 4; ++i)
            point += (*weights)[static_cast<int>(i)] * tetrahedron[i];
        const double square = (point - x).squaredNorm();
        if (square >= least) return;
        least = square;
        found.corners = {nodes[0]};
        found.weights = {(*weights)[0]};
        found.count = 1;
        if (!is_polyhedron)
            for (std::size_t k = 0; k < nodes.size(); ++k) {
                found.corners[k] = nodes[k];
                found.weights[k] = (*weights)[0] / static_cast<double>(nodes.size());
                found.count = static_cast<int>(k) + 1;
            }
        int i = 0;
        for (const VertexId n : {a, b, c}) {
            const auto end = found.corners.begin() + found.count;
            const auto known = std::find(found.corners.begin(), end, n);
            const auto k = static_cast<std::size_t>(known - found.corners.begin());
            if (known == end) ++found.count;
            found.corners[k] = n;
            found.weights[k] += (*weights)[++i];
        }
    };
    for (int f = 0; f < mesh.num_faces(cell); ++f) for_each_triangle(mesh, {cell, f}, look_at);
    return found;
}

std::optional<CellPoint> find_point(const Mesh& mesh, std::span<const Vec3> positions,
                                    const Vec3& x, double reach) {
    std::optional<CellPoint> found;
    double least = reach * reach;
    for (const CellId e : mesh.elements()) {
        Box box;
        for (const VertexId n : mesh.corners(e)) box.extend(positions[n.index()]);
        if (box.squaredExteriorDistance(x) > least) continue;
        const CellPoint near = point_near(mesh, e, positions, x);
        const double square = (near.position(positions) - x).squaredNorm();
        // Of cells at the same distance, the first.
        if (found ? square >= least : square > least) continue;
        found = near;
        least = square;
    }
    return found;
}

}  // namespace incise::topology
