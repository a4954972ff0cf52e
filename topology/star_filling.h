// Tetrahedra inside a closed surface of triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::topology {

/// The result of fill_surface().
struct StarFilling {
    /// Tetrahedra between corners of the surface, with positive volume.
    std::vector<std::array<std::int64_t, 4>> tetrahedra;
    /// The surface that they leave. The planes of its triangles all have the centre inside.
    std::vector<std::array<std::int64_t, 3>> triangles;
    Vec3 centre;
};

/// Fills a closed surface with tetrahedra of positive volume: tetrahedra between its corners are
/// taken off until a point sees all of the rest. If all tetrahedra are positive and their outer
/// faces are the surface, none overlaps another. Returns nothing if no such filling was found: the
/// surface crosses itself, or is far from star-shaped.
/// @param triangles  anticlockwise as seen from outside
/// @param points     by number, m
/// @param start      where the search of the centre begins: the centre if all triangles see it
/// Cost: O(n) if they do, else up to some milliseconds.
std::optional<StarFilling> fill_surface(std::vector<std::array<std::int64_t, 3>> triangles,
                                        std::span<const Vec3> points, const Vec3& start);

}  // namespace incise::topology
