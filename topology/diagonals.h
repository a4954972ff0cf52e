// Which quadrilaterals of a cell are divided into two triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <bit>
#include <cstdint>

#include "incise/topology/cell_kind.h"

namespace incise::topology {

/// The diagonals that divide quadrilaterals of a cell: two bits a face.
class Diagonals {
  public:
    /// Returns the position in the face of the first end of its diagonal: 0 or 1. The other end is
    /// two positions on. -1 for a face that is whole.
    constexpr int first_end(int face) const {
        return static_cast<int>(static_cast<unsigned>(bits_) >> (2 * face) & 3U) - 1;
    }
    constexpr bool divides(int face) const { return first_end(face) >= 0; }
    /// Divides a face that is whole.
    constexpr void divide(int face, int first_end) {
        bits_ = static_cast<std::uint16_t>(bits_ | (first_end + 1) << (2 * face));
    }
    constexpr bool is_none() const { return bits_ == 0; }
    constexpr int count() const { return std::popcount(bits_); }
    /// True if all that it divides are quadrilaterals of the kind of cell.
    constexpr bool fits(CellKind kind) const {
        const CellTraits& t = traits(kind);
        for (int f = 0; f < 8; ++f)
            if (divides(f) && (first_end(f) > 1 || f >= t.num_faces || t.face(f).size() != 4))
                return false;
        return true;
    }
    constexpr std::uint16_t bits() const { return bits_; }
    static constexpr Diagonals of_bits(std::uint16_t bits) {
        Diagonals diagonals;
        diagonals.bits_ = bits;
        return diagonals;
    }
    constexpr bool operator==(const Diagonals&) const = default;
    static void archive(auto& ar, auto& self) { ar(self.bits_); }

  private:
    std::uint16_t bits_ = 0;  // two a face: 0, or 1 + first_end
};

}  // namespace incise::topology
