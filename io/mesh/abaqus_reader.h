// Meshes of Abaqus and CalculiX (.inp).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// Reads an Abaqus or CalculiX file; see read_mesh(). Reads the nodes, elements and element sets of
/// a model without parts, or with one part and at most one instance that is not moved. Skips all
/// other sections. The text of a file stands in place of a line *INCLUDE; see abaqus_includes.h.
/// Throws InputError for keywords that generate nodes or elements (*NGEN, *ELGEN, ...) and for
/// other references to files.
///
/// Elements are in the order of their numbers, nodes in the order of the file. Regions are the sets
/// that have a *SOLID SECTION. If no set has one, regions are the sets given with the elements. If
/// there are none, regions are the other element sets. A set REGION_<n> is region n. Other sets are
/// numbered from 1, with a warning.
MeshFile read_abaqus(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
