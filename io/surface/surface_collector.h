// Collects the points and polygons of a surface file, checked, as triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

class SurfaceCollector {
  public:
    /// Both must outlive the collector. Refusals name the place of the scanner's last item.
    SurfaceCollector(const InputFile& file, const Scanner& scanner)
        : file_(file), scanner_(scanner) {}

    std::size_t num_points() const { return surface_.points.size(); }

    /// Throws InputError if a coordinate is not a number or too large.
    void add_point(const Vec3& point);
    /// The point whose coordinates are the first three words; throws InputError if they are not.
    void add_point(std::span<const std::string_view> words);

    /// Throws InputError if a corner is none of the points 0 to num_points - 1 that the file has.
    void check_corner(std::int64_t corner, std::uint64_t num_points) const;
    /// Throws InputError if there are fewer than three corners.
    /// @pre the corners are points when finish() is called
    void add_polygon(std::span<const std::int64_t> corners);

    /// Makes points of equal coordinates one, numbered by their first occurrence; 0 equals -0.
    /// Cost: O(n log n), whatever the points (a hash of them could be attacked).
    void merge_equal_points();

    /// The surface without triangles that have no area, which are counted in a warning. Throws
    /// InputError if no triangle is left. Afterwards the collector is empty.
    SurfaceFile finish();

  private:
    const InputFile& file_;
    const Scanner& scanner_;
    topology::SurfaceData surface_;
};

}  // namespace incise::io
