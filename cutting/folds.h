// Where a surface turns sharply within an element: which sheet of it is where, and on which side of
// it elements lie all of whose corners count as on it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <span>

#include "cutting/cut_surface.h"
#include "cutting/scars.h"

namespace incise::cutting {

/// Whether a surface that passes through an edge at the passage given as a scar of its end is the
/// sheet that left one of the end's scars, and not another beyond a fold: it runs in about the same
/// direction, about as far from the end. Of an end without scars, it is.
/// @param length  of the edge, m
bool is_same_sheet(std::span<const Scar> scars, const Scar& passage, double length);

/// Whether the straight way from the middle of the tetrahedron to one of its corners crosses the
/// surface. All are as they are after the step.
bool is_crossed_from_middle(const CutSurface& surface, const std::array<MovingPoint, 4>& corners,
                            const MovingPoint& corner);

}  // namespace incise::cutting
