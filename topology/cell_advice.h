// What a faulty cell was probably meant to be: the same cell with its corners in another order, or
// a cell of another kind.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// An order of corners: corner i of the new cell is corner order[i] of the old one.
using CornerOrder = std::array<int, max_corners>;

/// Returns an order of the corners that makes the cell sound: with positive volume, and with no
/// corner turned inside out. It tries the orders that programs confuse with VTK's: the mirrored
/// one, and those with one face of a prism or the base of a pyramid listed crosswise or backwards.
/// Of several sound ones it returns that with the largest volume, and nothing if there is none.
/// @param corners  positions of the corners in their present order
std::optional<CornerOrder> sound_order(CellKind kind, std::span<const Vec3> corners);

/// A cell by its corners.
struct CellByCorners {
    CellKind kind;
    std::vector<std::int64_t> corners;
};

/// Returns the cell of another kind with the same faces as a cell with repeated corners, or nothing
/// if no kind has these faces. Faces without area are left out of the comparison.
std::optional<CellByCorners> collapsed_cell(CellKind kind, std::span<const std::int64_t> corners);

}  // namespace incise::topology
