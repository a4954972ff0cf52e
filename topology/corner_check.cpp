// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/topology/corner_check.h"

#include <array>
#include <cstddef>

namespace incise::topology {

namespace {

/// The corners at the other ends of the three edges of a corner, in an order in which they span
/// positive volume where the element is not turned inside out.
/// @pre the corner has three edges
std::array<int, 3> edges_at_corner(const CellTraits& t, int corner) {
    // In each of the three faces at the corner, `next` is the corner after it and `previous` the
    // corner before it. Each edge at the corner is in two of these faces.
    std::array<int, 3> next{}, previous{};
    std::size_t found = 0;
    for (int f = 0; f < t.num_faces; ++f) {
        const auto face = t.face(f);
        for (std::size_t p = 0; p < face.size(); ++p)
            if (face[p] == corner) {
                next[found] = face[(p + 1) % face.size()];
                previous[found] = face[(p + face.size() - 1) % face.size()];
                ++found;
            }
    }
    // The first face has two of the three edges. The third edge is the one of the second face that
    // the first face does not have.
    const bool shares_next = next[1] == next[0] || next[1] == previous[0];
    return {previous[0], next[0], shares_next ? previous[1] : next[1]};
}

}  // namespace

std::optional<int> first_inverted_corner(CellKind kind, std::span<const Vec3> corners) {
    const CellTraits& t = traits(kind);
    for (int k = 0; k < t.num_corners; ++k) {
        if (kind == CellKind::pyramid && k == 4) continue;  // the apex has four edges
        const auto [from, along, third] = edges_at_corner(t, k);
        const Vec3& o = corners[static_cast<std::size_t>(k)];
        const auto edge = [&](int to) -> Vec3 { return corners[static_cast<std::size_t>(to)] - o; };
        if (!(edge(from).cross(edge(along)).dot(edge(third)) > 0.0)) return k;
    }
    return std::nullopt;
}

}  // namespace incise::topology
