// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/cell_point.h"

#include <cmath>
#include <limits>

#include "incise/topology/geometry.h"

namespace incise::topology {

namespace {

using Weights = std::array<double, max_corners>;

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

Vec3 CellPoint::position(const Mesh& mesh, std::span<const Vec3> positions) const {
    const auto corners = mesh.corners(cell);
    Vec3 x = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k)
        x += weights[k] * positions[corners[k].index()];
    return x;
}

CellPoint point_near(const Mesh& mesh, CellId cell, std::span<const Vec3> positions,
                     const Vec3& x) {
    const auto nodes = mesh.corners(cell);
    std::array<Vec3, max_corners> corners;
    for (std::size_t k = 0; k < nodes.size(); ++k) corners[k] = positions[nodes[k].index()];
    CellPoint found{cell};
    found.weights[0] = 1.0;
    const auto count = static_cast<double>(nodes.size());
    if (mesh.kind(cell) == CellKind::tetrahedron) {
        if (const auto weights = weights_near({corners[0], corners[1], corners[2], corners[3]}, x))
            for (std::size_t k = 0; k < 4; ++k) found.weights[k] = (*weights)[static_cast<int>(k)];
        return found;
    }
    const Vec3 middle = centre(std::span(corners).first(nodes.size()));
    const CellTraits& traits_of_cell = traits(mesh.kind(cell));
    double least = std::numeric_limits<double>::infinity();
    for (int f = 0; f < traits_of_cell.num_faces; ++f) {
        const auto face = traits_of_cell.face(f);
        for (std::size_t k = 2; k < face.size(); ++k) {
            const std::array<std::size_t, 3> of_triangle = {static_cast<std::size_t>(face[0]),
                                                            static_cast<std::size_t>(face[k - 1]),
                                                            static_cast<std::size_t>(face[k])};
            const std::array<Vec3, 4> tetrahedron = {
                middle, corners[of_triangle[0]], corners[of_triangle[1]], corners[of_triangle[2]]};
            const auto weights = weights_near(tetrahedron, x);
            if (!weights) continue;
            Vec3 point = Vec3::Zero();
            for (std::size_t i = 0; i < 4; ++i)
                point += (*weights)[static_cast<int>(i)] * tetrahedron[i];
            if (const double square = (point - x).squaredNorm(); square < least) {
                least = square;
                Weights all{};
                for (std::size_t i = 0; i < nodes.size(); ++i) all[i] = (*weights)[0] / count;
                for (std::size_t i = 0; i < 3; ++i)
                    all[of_triangle[i]] += (*weights)[static_cast<int>(i + 1)];
                found.weights = all;
            }
        }
    }
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
        const double square = (near.position(mesh, positions) - x).squaredNorm();
        // Of cells at the same distance, the first.
        if (found ? square >= least : square > least) continue;
        found = near;
        least = square;
    }
    return found;
}

}  // namespace incise::topology
