// The mesh file that a verb reads, and how the command line says to read it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "incise/io/mesh/mesh_reader.h"

namespace incise::app {

/// How to read a mesh file.
struct MeshInput {
    std::string region_array{io::ReadOptions::usual_region_array};
    bool linear = false;  ///< read cells of higher order by their corners
    bool weld = false;    ///< join points at the same position
};

/// Reads a mesh file as io::read_mesh() does. Refusals name the options of the program. Does not
/// join points; see weld_input().
io::MeshFile read_input(const std::filesystem::path& path, const MeshInput& input);

/// Joins points at the same position if `input` says so, and adds the report to the warnings. No
/// point is removed.
void weld_input(io::MeshFile& file, const MeshInput& input);

/// Returns the number of points without those that were joined to others.
std::size_t num_points(const topology::MeshData& mesh);

}  // namespace incise::app
