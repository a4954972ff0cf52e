// Tools that remove the elements that they cover, as cautery, suction or a burr does.
// Source: [Forest 2005] in docs/glossary.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <variant>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/tools/shapes.h"
#include "incise/topology/pose.h"

namespace incise::cutting {

struct TissueMotion;

using CarverShape = std::variant<Sphere, Capsule, Cuboid>;

/// True if the segment from a to b, in the frame of the tool, meets the shape or its surface.
bool meets(const CarverShape& shape, const Vec3& a, const Vec3& b);

/// Returns the elements whose centre the shape covers at some time of the step, in ascending order.
/// Tool and tissue both move. The path of a centre in the frame of the tool is taken as straight.
/// Cost: proportional to the elements near the path of the tool if `tissue` has boxes, else O(n).
std::vector<CellId> covered_elements(const TissueMotion& tissue, const CarverShape& shape,
                                     const Pose& before, const Pose& after);

}  // namespace incise::cutting
