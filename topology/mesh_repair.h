// Repair of frequent errors in meshes from files: points that are not joined, and cells whose
// corners are in the wrong order.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"

namespace incise::topology {

/// Two points count as being at one position if their distance is at most this fraction of the
/// shortest edge. The fraction is well above the rounding of coordinates in single precision, and
/// far below all lengths that a mesh resolves.
inline constexpr double weld_tolerance = 1e-4;

/// Two boundary points whose distance is at most this fraction of the shortest edge form a gap that
/// is probably an error.
inline constexpr double near_tolerance = 1e-2;

/// Returns a warning if points that cells use lie at one position (see weld_tolerance), or if
/// boundary points lie near each other (see near_tolerance). The warning proposes welding where
/// welding joins cells. There is no warning if MeshData::points_may_coincide is set.
/// Cost: O(n log n) in the number of points, some 0.3 us each.
/// @pre  corners are valid point numbers, and all coordinates are finite
std::optional<std::string> coincidence_warning(const MeshData& data, const WeldAdvice& advice = {});

/// Joins points at one position: cells then use the one with the lowest number. Returns how many
/// points were joined to a lower one. No point is removed or renumbered; MeshData::welded_to names
/// the point that replaced each point. Corners of carriers move with the points at them. Faces on
/// cuts that then have the same points are on a cut no longer. Welding can make cells invalid: use
/// check() afterwards.
/// @pre  corners are valid point numbers, and all coordinates are finite
std::size_t weld(MeshData& data);

/// Returns a sentence that reports the result of weld().
std::string weld_report(std::size_t num_joined);

/// Removes the points that were welded to others. Later points get lower numbers.
void drop_welded_points(MeshData& data);

/// The cells that turn_inverted_cells() has turned.
struct TurnedCells {
    std::vector<CellKind> kinds;  ///< in the order of CellKind
    std::size_t num_cells = 0;    ///< cells of these kinds with negative volume
};

/// Reverses the corner order of all cells of a kind if every cell of that kind has negative volume.
/// Cells whose volume is zero to rounding are ignored in this test, but are reversed too. Of
/// polyhedra the faces are reversed. The same holds for carriers, by their own volumes. A kind is
/// judged by itself, since programs differ in their order of the corners of a single kind, such as
/// wedges.
/// @pre  corners are valid point numbers, and all coordinates are finite
TurnedCells turn_inverted_cells(MeshData& data);

}  // namespace incise::topology
