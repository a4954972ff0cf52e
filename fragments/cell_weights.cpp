// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/fragments/cell_weights.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "incise/fragments/centre_division.h"

namespace incise::fragments {

using topology::CellKind;
using topology::max_corners;

namespace {

using Weights = std::array<double, max_corners>;

/// A point closer than this to a face or an edge is on it: a barycentric coordinate.
constexpr double nearness = 1e-12;

bool comes_before(const Vec3& a, const Vec3& b) {
    for (int c = 0; c < 3; ++c)
        if (a[c] != b[c]) return a[c] < b[c];
    return false;
}

std::array<double, 4> barycentric(const std::array<Vec3, 4>& points, const Vec3& x) {
    Eigen::Matrix3d edges;
    edges << points[1] - points[0], points[2] - points[0], points[3] - points[0];
    const Vec3 local = edges.partialPivLu().solve(x - points[0]);
    return {1.0 - local.sum(), local[0], local[1], local[2]};
}

/// Returns the coordinates of the projection of x onto the plane of a triangle.
std::array<double, 3> barycentric_in_triangle(const std::array<Vec3, 3>& points, const Vec3& x) {
    const Vec3 u = points[1] - points[0], v = points[2] - points[0], w = x - points[0];
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), wu = w.dot(u), wv = w.dot(v);
    const double determinant = uu * vv - uv * uv;
    const double b = (vv * wu - uv * wv) / determinant, c = (uu * wv - uv * wu) / determinant;
    return {1.0 - b - c, b, c};
}

/// Returns the weights for a point on the edge between two corners of a cell.
Weights weights_on_edge(std::span<const Vec3> corners, std::size_t a, std::size_t b,
                        const Vec3& x) {
    if (comes_before(corners[b], corners[a])) std::swap(a, b);
    const Vec3 edge = corners[b] - corners[a];
    const double along = edge.dot(x - corners[a]) / edge.squaredNorm();
    Weights weights{};
    weights[a] = std::abs(along) < nearness         ? 1.0
                 : std::abs(1.0 - along) < nearness ? 0.0
                                                    : 1.0 - along;
    weights[b] = 1.0 - weights[a];
    return weights;
}

/// Returns the corners of a face in an order that depends on their positions only.
std::vector<std::size_t> ordered(std::span<const int> face, std::span<const Vec3> corners) {
    std::vector<std::size_t> all(face.begin(), face.end());
    const auto is_before = [&](std::size_t a, std::size_t b) {
        return comes_before(corners[a], corners[b]);
    };
    std::ranges::rotate(all, std::ranges::min_element(all, is_before));
    if (is_before(all.back(), all[1])) std::reverse(all.begin() + 1, all.end());
    return all;
}

/// Returns the half of a quadrilateral nearest to a point.
std::array<int, 3> half_at(std::span<const Vec3> corners, std::span<const int> face, int first_end,
                           const Vec3& x) {
    std::array<int, 3> best{};
    double highest = -std::numeric_limits<double>::infinity();
    for (const int first : {first_end, first_end + 2}) {
        std::array<int, 3> half{};
        std::array<Vec3, 3> at;
        for (std::size_t k = 0; k < 3; ++k) {
            half[k] = face[(static_cast<std::size_t>(first) + k) % 4];
            at[k] = corners[static_cast<std::size_t>(half[k])];
        }
        const double least = std::ranges::min(barycentric_in_triangle(at, x));
        if (least <= highest) continue;
        highest = least;
        best = half;
    }
    return best;
}

/// Returns the weights for a point on a face of a cell.
Weights weights_on_face(std::span<const Vec3> corners, std::span<const int> face, const Vec3& x) {
    const std::vector<std::size_t> at = ordered(face, corners);
    Weights weights{};
    if (at.size() == 3) {
        const auto b = barycentric_in_triangle({corners[at[0]], corners[at[1]], corners[at[2]]}, x);
        for (std::size_t k = 0; k < 3; ++k) {
            if (std::abs(b[k]) < nearness)
                return weights_on_edge(corners, at[(k + 1) % 3], at[(k + 2) % 3], x);
            weights[at[k]] = b[k];
        }
        return weights;
    }
    const Vec3 centre = 0.25 * (corners[at[0]] + corners[at[1]] + corners[at[2]] + corners[at[3]]);
    std::size_t best = 0;
    std::array<double, 3> of_best{};
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < 4; ++p) {
        const auto b =
            barycentric_in_triangle({corners[at[p]], corners[at[(p + 1) % 4]], centre}, x);
        const double least = *std::ranges::min_element(b);
        if (least <= highest) continue;
        highest = least;
        best = p;
        of_best = b;
    }
    const std::size_t first = at[best], second = at[(best + 1) % 4];
    if (std::abs(of_best[2]) < nearness) return weights_on_edge(corners, first, second, x);
    for (const std::size_t k : at) weights[k] = 0.25 * of_best[2];
    weights[first] += of_best[0];
    weights[second] += of_best[1];
    return weights;
}

template <class Division>
Weights weights_in(std::span<const Vec3> corners, const Vec3& x, Diagonals diagonals) {
    static constexpr auto parts = Division::parts();
    typename Division::Corners of_cell;
    std::ranges::copy(corners, of_cell.begin());
    const auto at = Division::points(of_cell, diagonals);
    std::size_t best = 0;
    std::array<double, 4> of_best{};
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t t = 0; t < parts.size(); ++t) {
        const auto& p = parts[t];
        const auto b = barycentric({at[p[0]], at[p[1]], at[p[2]], at[p[3]]}, x);
        const double least = *std::ranges::min_element(b);
        if (least <= highest) continue;
        highest = least;
        best = t;
        of_best = b;
    }
    if (std::abs(of_best[0]) < nearness) {
        const int f = Division::face_of_part(best);
        const auto face = Division::traits.face(f);
        return diagonals.divides(f)
                   ? weights_on_face(corners, half_at(corners, face, diagonals.first_end(f), x), x)
                   : weights_on_face(corners, face, x);
    }
    std::array<double, Division::num_points> of_points{};
    for (std::size_t k = 0; k < 4; ++k) of_points[parts[best][k]] = of_best[k];
    Weights weights{};
    std::ranges::copy(Division::gathered(of_points, diagonals), weights.begin());
    return weights;
}

}  // namespace

Weights weights_in_cell(CellKind kind, std::span<const Vec3> corners, const Vec3& x,
                        Diagonals diagonals) {
    return with_division(kind, [&]<class Division>(Division) {
        return weights_in<Division>(corners, x, diagonals);
    });
}

}  // namespace incise::fragments
