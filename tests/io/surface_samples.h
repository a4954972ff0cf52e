// A small surface in every format and encoding that the readers of surfaces know.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "incise/topology/surface_data.h"
#include "tests/io/reader_samples.h"

namespace incise::io {

struct Polygons {
    std::vector<Vec3> points;  ///< in the order in which the polygons use them, as STL has them
    std::vector<std::vector<std::int64_t>> polygons;

    /// With a fan in place of each polygon.
    topology::SurfaceData triangulated() const;
};

/// Closed, with coordinates of all sizes that are exact in single precision.
Polygons tetrahedron();
/// Closed, of quadrilaterals.
Polygons cube();

std::string ascii_stl(const topology::SurfaceData& surface);
/// `title` is what the file begins with.
std::string binary_stl(const topology::SurfaceData& surface, std::string title = "made by hand");
/// With texture coordinates and normals; the last face counts its points backwards.
std::string obj(const Polygons& surface);
/// With colours and comments.
std::string off(const Polygons& surface, const std::string& keyword = "OFF");
/// With other properties and elements of many types before, among and behind.
std::string ply(const Polygons& surface, const std::string& encoding, bool are_faces_first);

/// The surface in all of them; names begin with ascii where they are text.
std::vector<Sample> surface_samples(const Polygons& surface);

}  // namespace incise::io
