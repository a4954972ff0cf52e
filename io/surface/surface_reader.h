// Reading of triangulated surfaces from files: the one entry point for every format.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "incise/topology/surface_data.h"

namespace incise::io {

/// The contents of a surface file.
struct SurfaceFile {
    topology::SurfaceData surface;
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file
};

/// True if the name ends as those of surface files do: in .stl, .ply, .off or .obj, in upper or
/// lower case.
bool has_surface_suffix(const std::filesystem::path& path);

/// Reads the polygons of a file as triangles, in the order and with the orientation of the file.
/// The contents of the file decide its format, or else its suffix. Formats: STL (ascii and binary),
/// PLY (ascii and binary of either byte order), OFF (text), OBJ (by its suffix only).
///
/// A polygon with more than three corners becomes a fan of triangles round its first corner, which
/// is correct for plane convex polygons. Triangles without area in double precision become part of
/// their neighbours, so that a closed surface stays closed. Those that have no such neighbour, and
/// those with repeated corners, are left out. A warning states their number. STL has no shared
/// points, so that its points with equal coordinates are merged. Other formats keep all points,
/// also those without a triangle. Normals, texture coordinates, colours, lines and all other data
/// are skipped.
///
/// Every count, index and number is checked before it is used. Memory is proportional to the size
/// of the file. The result has at least one triangle. Its corners are numbers of points, and its
/// coordinates lie between -1e100 and 1e100.
/// Throws InputError that names the file, the line or byte, what was found and a remedy.
/// Cost: linear in the size of the file; for STL, O(n log n) in the number of triangles.
SurfaceFile read_surface(const std::filesystem::path& path);

}  // namespace incise::io
