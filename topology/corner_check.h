// Test of the corners of hexahedra, wedges and pyramids: at each, the edges must span a volume.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// Returns the first corner at which the three edges span no positive volume, or nothing if there
/// is none. It skips the apex of a pyramid, which has four edges.
std::optional<int> first_inverted_corner(CellKind kind, std::span<const Vec3> corners);

}  // namespace incise::topology
