// The shape of a body that closed surfaces enclose.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "incise/topology/surface_data.h"
#include "tetmesh/body_shape.h"

namespace incise::tetmesh {

/// A surface, and its name for messages.
struct NamedSurface {
    std::string name;
    topology::SurfaceData surface;
};

/// Returns the shape of the body. The region at a point is that of the innermost closed part round
/// it. A part that faces inwards within another one is a cavity, of no region.
///
/// Regions are numbered from 1. Of one surface, each closed part that is no cavity is a region, in
/// the order of the parts. Of several surfaces, each is a region.
///
/// Throws InputError, with the name and the place, for surfaces that are open or cross themselves
/// or each other.
/// @param angle  at which an edge is sharp, rad; without it no edge is kept
BodyShape shape_of(const std::vector<NamedSurface>& surfaces, std::optional<double> angle);

}  // namespace incise::tetmesh
