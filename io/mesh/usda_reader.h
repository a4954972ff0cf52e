// Meshes of USD as text (.usda): prims of the type TetMesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads a text file of USD; see read_mesh(). Reads the points, tetrahedra and subsets of each prim
/// that is defined as a TetMesh, one behind the other, and skips all other prims and properties.
/// Points are multiplied by metersPerUnit, with a warning. Regions are the subsets of the element
/// type tetrahedron: REGION_<n> is region n, and REGION_m<n> is region -n. Other names are numbered
/// from 1, with a warning.
///
/// Throws InputError for points that change in time, and for a mesh that a transformation moves.
/// Other files that the file refers to are not read. Variants are not read.
MeshFile read_usda(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
