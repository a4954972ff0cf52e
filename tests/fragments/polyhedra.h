// Closed surfaces of triangles, and their halves on one side of a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "incise/fragments/centre_division.h"
#include "incise/topology/geometry.h"

namespace incise::test {

using Surface = std::vector<std::array<Vec3, 3>>;

inline double volume_of(const Surface& surface) {
    double sum = 0.0;
    if (surface.empty()) return sum;
    const Vec3 apex = surface[0][0];
    for (const auto& [a, b, c] : surface) sum += topology::tetrahedron_volume(a, b, c, apex);
    return -sum;
}

/// Returns the boundary of a tetrahedron of positive volume.
inline Surface surface_of_tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    return {{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
}

/// Returns the boundary of a cell; faces of four corners are divided about their centres.
template <topology::CellKind kind>
Surface surface_of_cell(const typename fragments::CentreDivision<kind>::Corners& corners,
                        topology::Diagonals diagonals = {}) {
    const auto at = fragments::CentreDivision<kind>::points(corners, diagonals);
    Surface surface;
    for (const auto& p : fragments::CentreDivision<kind>::parts())
        surface.push_back({at[p[1]], at[p[2]], at[p[3]]});
    return surface;
}

/// Returns the half of a polyhedron on the side of a plane that its normal points to.
inline Surface half_of(const Surface& surface, const Vec3& point, const Vec3& normal) {
    Surface half;
    std::vector<std::pair<Vec3, Vec3>> rim;  // edges on the plane, as the cut face has them
    for (const std::array<Vec3, 3>& triangle : surface) {
        std::vector<Vec3> polygon;
        Vec3 leaves = Vec3::Zero(), comes = Vec3::Zero();
        bool is_cut = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = triangle[k], &b = triangle[(k + 1) % 3];
            const double of_a = normal.dot(a - point), of_b = normal.dot(b - point);
            if (of_a >= 0.0) polygon.push_back(a);
            if ((of_a >= 0.0) == (of_b >= 0.0)) continue;
            // From the same end on both sides of the edge.
            const Vec3 x = of_a >= 0.0 ? Vec3(a + of_a / (of_a - of_b) * (b - a))
                                       : Vec3(b + of_b / (of_b - of_a) * (a - b));
            polygon.push_back(x);
            (of_a >= 0.0 ? leaves : comes) = x;
            is_cut = true;
        }
        for (std::size_t k = 2; k < polygon.size(); ++k)
            half.push_back({polygon[0], polygon[k - 1], polygon[k]});
        if (is_cut) rim.emplace_back(comes, leaves);
    }
    if (rim.empty()) return half;
    for (const auto& [from, to] : rim) half.push_back({rim[0].first, from, to});
    return half;
}

}  // namespace incise::test
