// What is often wrong with a mesh from a file and can be put right: points that are not joined,
// cells that are wound the wrong way round.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Two points are at one position if they are nearer to each other than this part of the shortest
/// edge. It is well above the rounding of single precision in coordinates, and far below anything
/// that a mesh resolves.
inline constexpr double weld_tolerance = 1e-4;

/// Points of the boundary nearer to each other than this part of the shortest edge are a gap that
/// is hardly meant.
inline constexpr double near_tolerance = 1e-2;

/// A warning about points that cells use and that lie where another such point lies, or on the
/// boundary and near another one there, unless they may (MeshData::points_may_coincide). It offers
/// welding where that joins cells.
/// @pre  corners are numbers of points, whose coordinates are finite
/// Cost: O(n log n) in the number of points, some 0.3 us each.
std::optional<std::string> coincidence_warning(const MeshData& data);

/// Joins the points at one position: cells then have the lowest of them. No point is removed or
/// renumbered: MeshData::welded_to tells what became of each. Returns how many points were joined
/// to a lower one. Whether the cells still are sound after that, check() tells.
/// @pre  as above
std::size_t weld(MeshData& data);

/// What weld() did, in words.
std::string weld_report(std::size_t num_joined);

/// Removes the points that were welded to others. Later points move up.
void drop_welded_points(MeshData& data);

/// Winds all cells the other way round if every cell has negative volume, but for cells without
/// volume to rounding. Returns how many had negative volume, or zero if none was turned.
/// @pre  as above
std::size_t turn_inverted_cells(MeshData& data);

}  // namespace incise::topology
