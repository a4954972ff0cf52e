// Meshes of Abaqus and CalculiX (.inp).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/io/files/input_file.h"
#include "incise/io/mesh/mesh_reader.h"

namespace incise::io {

/// See read_mesh. Reads the nodes, elements and element sets of a model without parts, or with
/// one part and at most one instance that stays where the part is; steps over all else. What
/// makes nodes or elements of others (*NGEN, *ELGEN, ...) or lies in other files is refused.
///
/// Elements come in the order of their numbers, nodes in the order of the file. Regions are the
/// sets that have a *SOLID SECTION; if none has, those given with the elements; else the other
/// element sets. A set REGION_<n> is region n, others are numbered from 1 with a warning.
MeshFile read_abaqus(const InputFile& file, const ReadOptions& options);

}  // namespace incise::io
