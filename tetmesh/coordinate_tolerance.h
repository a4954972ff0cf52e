// How far points that are meant to be one may be apart.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>

#include "incise/topology/surface_parts.h"

namespace incise::tetmesh {

/// Returns the distance within which points of a body count as one: files hold coordinates in
/// single precision, so that what touches may cross by their last digits. Far from the origin the
/// tolerance stays small beside the body.
inline double coordinate_tolerance(const Box& box) {
    constexpr double last_digits = 1e-6, small = 1e-4;
    const double largest =
        std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
    return std::min(last_digits * largest, small * box.sizes().maxCoeff());
}

/// Returns the box round several surfaces.
inline Box box_of(const std::vector<topology::SurfaceParts>& surfaces) {
    Box box;
    for (const auto& surface : surfaces) box.extend(surface.box);
    return box;
}

}  // namespace incise::tetmesh
