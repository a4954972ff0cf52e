// Where surfaces cross themselves or each other.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "incise/topology/surface_parts.h"

namespace incise::tetmesh {

/// Pairs of triangles that cross.
struct Crossing {
    std::size_t num_pairs = 0;
    std::size_t first_surface = 0, second_surface = 0;  ///< of the first pair
    Vec3 place = Vec3::Zero();                          ///< of the first pair
};

/// How surfaces meet.
struct SurfaceContacts {
    std::optional<Crossing> crossing;
    bool do_parts_touch = false;  ///< two parts, of one surface or of two
};

/// Returns where surfaces cross. Two triangles of one part cross if they have more in common than a
/// point, an edge or what neighbours share. Triangles of two parts cross if each of them passes
/// through the other: parts may touch. Cost: O(n log n) for triangles of like size.
SurfaceContacts contacts_of(const std::vector<topology::SurfaceParts>& surfaces);

}  // namespace incise::tetmesh
