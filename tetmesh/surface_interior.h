// The inside of a closed surface: exact tests of points.
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/surface_data.h"

namespace incise::tetmesh {

/// Where a point is.
enum class Side { outside, on, inside };

/// The inside of a closed surface. A line goes up from the point; it leaves the surface an odd
/// number of times if the point is inside. Every decision is exact, and the line counts as moved by
/// less than any number, so that it never meets an edge. Which way triangles face does not matter.
class SurfaceInterior {
  public:
    /// @param triangles  numbers of the triangles of the surface that enclose the inside
    /// Cost: O(n) for triangles of like size.
    SurfaceInterior(const topology::SurfaceData& surface, std::span<const std::size_t> triangles);

    /// Cost: the triangles above and below the point, some 0.1 us.
    Side side_of(const Vec3& x) const;

    const Box& box() const { return box_; }

  private:
    using Triangle = std::array<Vec3, 3>;

    std::size_t column(std::size_t axis, double place) const;

    std::vector<Triangle> triangles_;
    Box box_;
    // Columns of a lattice across x and y. Column c has the triangles listed_ from begins_[c] to
    // begins_[c + 1].
    std::array<std::size_t, 2> num_columns_{};
    std::array<double, 2> widths_{};
    std::vector<std::uint32_t> begins_, listed_;
};

}  // namespace incise::tetmesh
