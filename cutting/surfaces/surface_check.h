// Checks whether a triangulated surface is a single sheet, as cuts require.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/surface_data.h"

namespace incise::cutting {

/// Returns a sentence with a position for each kind of defect of a surface. Returns nothing for a
/// sheet that does not meet itself. Where parts of a surface meet, it may pass through an edge of
/// tissue twice. Two intersections count as none, and tissue stays joined.
///
/// The kinds of defects are:
/// - edges of more than two triangles
/// - triangles that pass through each other
/// - triangles that lie upon each other
///
/// Points at the same position count as one, and triangles without area are ignored. A corner on
/// the boundary of another triangle is no defect. So sheets are not found that cross exactly along
/// edges of both, if these edges are divided differently. Decisions hold to rounding errors.
/// Cost: O(n log n).
std::vector<std::string> defects_of_surface(const topology::SurfaceData& surface);

}  // namespace incise::cutting
