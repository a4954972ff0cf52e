// Reading of volume meshes from files: the one entry point for every format.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "incise/base/error.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

struct ReadOptions {
    static constexpr std::string_view usual_region_array = "region";

    /// VTU and legacy VTK: the cell array of whole numbers that becomes MeshData::regions.
    /// Where a file has no array of the usual name, all regions are 0; one of another name must be
    /// there. Other formats have regions of their own, and this is without meaning.
    std::string region_array{usual_region_array};

    /// VTU and legacy VTK: cell arrays of three components that are read too. Each must be there.
    std::vector<std::string> vector_arrays = {};

    bool must_have_regions() const { return region_array != usual_region_array; }
};

/// The file begins like none of the formats.
struct UnknownFormat : InputError {
    using InputError::InputError;
};

/// True if the text begins as one of the mesh formats does that are known by that.
bool begins_like_a_mesh(std::string_view text);

struct MeshFile {
    topology::MeshData mesh;
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file
    /// Of the options' vector_arrays: by name, one vector a cell of `mesh`, unchecked.
    std::map<std::string, std::vector<Vec3>> cell_vectors = {};
};

/// Reads the tetrahedra, hexahedra, wedges and pyramids of a file, in the file's order (of
/// Abaqus: of their numbers).
/// The format is told by the content first, by the suffix second. Formats: VTU (all encodings),
/// legacy VTK unstructured grids, Gmsh 2 and 4.1, MEDIT (text), TetGen (either file of the pair
/// .node and .ele), Abaqus and CalculiX (see abaqus_reader.h).
///
/// Vertices, lines and surface cells are left out with a warning. A point array `rest_position`
/// of a VTK file takes the place of its points. Regions are the cell array of the options, Gmsh's
/// physical groups, MEDIT's references, TetGen's first attribute, sets of elements in Abaqus.
///
/// Cells that all have negative volume are turned, with a warning. Points may coincide
/// (MeshData::points_may_coincide) in frames of runs and in what `incise cut` writes.
///
/// The contents are trusted in nothing: every count, offset and index is checked before it is
/// used, and memory stays proportional to the size of the file (compressed files: to what
/// their blocks unpack to). Coordinates of cells are finite. Left to Mesh::build: the shape of the
/// cells, and points that are not joined.
/// Throws InputError that names the file, the line, byte or cell, what was found and what to do.
MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace incise::io
