// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/body/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "incise/topology/geometry.h"

namespace incise::physics {

namespace {

/// One element at one of its edges.
struct Wedge {
    VertexId a, b;  // a < b
    CellId element;
    double angle;  // dihedral, rad; not a number for a flat or inverted element
};

/// Returns the angle between the two faces at the edge from corner 0 to corner 1, rad.
double dihedral_angle(const Vec3& x0, const Vec3& x1, const Vec3& x2, const Vec3& x3) {
    const Vec3 edge = x1 - x0, m = edge.cross(x2 - x0), n = edge.cross(x3 - x0);
    return std::atan2(m.cross(n).norm(), m.dot(n));
}

}  // namespace

Winding find_winding(const topology::Mesh& mesh, std::span<const Vec3> positions) {
    // Both corners of each edge, then the other two corners.
    constexpr std::array<std::array<std::size_t, 4>, 6> edges = {
        {{0, 1, 2, 3}, {0, 2, 1, 3}, {0, 3, 1, 2}, {1, 2, 0, 3}, {1, 3, 0, 2}, {2, 3, 0, 1}}};
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<Wedge> wedges;
    for (const CellId e : mesh.elements()) {
        if (mesh.kind(e) != topology::CellKind::tetrahedron) continue;
        const auto corners = mesh.corners(e);
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k) x[k] = positions[corners[k].index()];
        const bool is_in_order = topology::tetrahedron_volume(x[0], x[1], x[2], x[3]) > 0.0;
        for (const auto& [a, b, c, d] : edges)
            wedges.push_back({std::min(corners[a], corners[b]), std::max(corners[a], corners[b]), e,
                              is_in_order ? dihedral_angle(x[a], x[b], x[c], x[d]) : none});
    }
    std::sort(wedges.begin(), wedges.end(), [](const Wedge& u, const Wedge& v) {
        return std::array{u.a.index(), u.b.index(), u.element.index()} <
               std::array{v.a.index(), v.b.index(), v.element.index()};
    });
    constexpr double one_and_a_half_turns = 3.0 * std::numbers::pi;
    Winding winding;
    for (auto first = wedges.begin(); first != wedges.end();) {
        double angle = 0.0;
        auto next = first;
        for (; next != wedges.end() && next->a == first->a && next->b == first->b; ++next)
            angle += next->angle;
        if (angle > one_and_a_half_turns) {
            if (winding.num_edges == 0 || first->element < winding.element)
                winding.element = first->element;
            ++winding.num_edges;
        }
        first = next;
    }
    return winding;
}

}  // namespace incise::physics
