// A collector of the points and polygons of a surface file, which checks and triangulates them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "incise/io/files/scanner.h"
#include "incise/io/surface/surface_reader.h"

namespace incise::io {

/// A collector of points and triangles. Its error messages name the last item of the scanner.
class SurfaceCollector {
  public:
    /// @lifetime  the file and the scanner must outlive the collector
    SurfaceCollector(const InputFile& file, const Scanner& scanner)
        : file_(file), scanner_(scanner) {}

    std::size_t num_points() const { return surface_.points.size(); }

    /// Adds a point. Throws InputError if a coordinate is not a number, or beyond 1e100.
    void add_point(const Vec3& point);
    /// Adds the point whose coordinates are the first three words. Throws InputError also if these
    /// are not numbers.
    void add_point(std::span<const std::string_view> words);

    /// Throws InputError unless the corner is one of the points 0 to num_points - 1.
    void check_corner(std::int64_t corner, std::uint64_t num_points) const;
    /// Adds a polygon as a fan of triangles round its first corner. Throws InputError if there are
    /// fewer than three corners.
    /// @pre  the corners are numbers of points, at the latest when finish() is called
    void add_polygon(std::span<const std::int64_t> corners);

    /// Merges points with equal coordinates. The merged points are in the order of their first
    /// occurrence; 0 equals -0. Cost: O(n log n) for any points. A hash table could be slowed down
    /// by a file made for that.
    void merge_equal_points();

    /// Returns the surface without flat triangles: topology::without_flat_triangles(). A warning
    /// states the number of those that were left out.
    /// Throws InputError if no triangle is left. The collector is empty afterwards.
    SurfaceFile finish();

  private:
    const InputFile& file_;
    const Scanner& scanner_;
    topology::SurfaceData surface_;
};

}  // namespace incise::io
