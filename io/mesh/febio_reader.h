// Meshes of FEBio (.feb).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// True if the text is XML whose first element is that of a file of FEBio: a model, febio_spec, or
/// another file, which read_febio() refuses.
bool begins_as_febio(std::string_view text);

/// Reads a FEBio file of version 2, 3 or 4; see read_mesh(). Reads the nodes, the elements and the
/// element sets of the section Geometry or Mesh, and skips all else. Throws InputError for parts
/// with instances (version 2.5) and for references to other files.
///
/// Points and elements are in the order of the file. In version 2, regions are the numbers `mat` of
/// the materials. Else they are the names of the blocks of elements, or, if these have none, the
/// element sets: REGION_<n> is region n, other names are numbered from 1, with a warning.
MeshFile read_febio(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
