// Sections of tetrahedra by planes, to judge cuts by.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "incise/base/types.h"

namespace incise::test {

/// Returns the polygon in which a plane cuts a tetrahedron: no corner, three or four in order.
/// Corners of the tetrahedron exactly in the plane do not count.
std::vector<Vec3> plane_section(const std::array<Vec3, 4>& corners, const Vec3& point,
                                const Vec3& normal);

/// Returns the area of a flat polygon; 0 for less than three corners.
double polygon_area(std::span<const Vec3> polygon);

}  // namespace incise::test
