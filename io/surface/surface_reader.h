// Reading of triangulated surfaces from files: the one entry point for every format.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "incise/topology/surface_data.h"

namespace incise::io {

struct SurfaceFile {
    topology::SurfaceData surface;
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file
};

/// Reads the polygons of a file as triangles, in the file's order and sense. The format is told
/// by the content first, by the suffix second. Formats: STL (ascii and binary), PLY (ascii and
/// binary of either byte order), OFF (text), OBJ (by its suffix only).
///
/// A polygon with more than three corners becomes a fan around its first one, which is right for
/// plane convex polygons. Triangles with repeated corners or without area (in double precision)
/// are left out with a warning that counts them. Points equal to the bit become one in STL, which
/// knows no shared points; the other formats keep theirs, also those that no triangle uses.
/// Normals, texture coordinates, colours, lines and all other data are skipped.
///
/// The contents are trusted in nothing: every count, index and number is checked before it is
/// used, and memory stays proportional to the size of the file. On return there is at least one
/// triangle, corners are point numbers, and coordinates lie between -1e100 and 1e100.
/// Throws InputError that names the file, the line or byte, what was found and what to do.
/// Cost: O(size of the file); STL: O(#triangles log #triangles).
SurfaceFile read_surface(const std::filesystem::path& path);

}  // namespace incise::io
