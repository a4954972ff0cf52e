// Whether a triangulated surface is one sheet, as a cut along it takes it to be.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/surface_data.h"

namespace incise::cutting {

/// What keeps the triangles from being one sheet that does not meet itself: a sentence with a
/// place for edges of more than two triangles, for triangles that pass through each other, and for
/// those that lie upon each other; empty for a sheet. Where sheets meet, an edge of tissue may be
/// passed twice, which counts as not at all: tissue stays joined.
/// Points at the same place count as one. Triangles without area count for nothing. Corners that
/// lie on the boundary of another triangle are none of these, and so sheets that cross just along
/// edges of both, divided differently there, go unnoticed. To rounding errors. Cost: O(n log n).
std::vector<std::string> defects_of_sheet(const topology::SurfaceData& surface);

}  // namespace incise::cutting
