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

/// Options of read_mesh().
struct ReadOptions {
    static constexpr std::string_view usual_region_array = "region";

    /// For VTU and legacy VTK: the cell array of whole numbers that becomes MeshData::regions. If
    /// the file has no array of the usual name, all regions are 0. An array of another name must
    /// exist. Other formats ignore this option.
    std::string region_array{usual_region_array};

    /// True if second-order cells, and those of higher order, are read by their corners as linear
    /// ones, with a warning. Else they are refused.
    bool linear = false;

    /// What the refusal of such cells tells the user to do. The default is for programs that use
    /// the library.
    std::string linear_advice = "read them by their corners with ReadOptions::linear";

    /// For VTU and legacy VTK: cell arrays of three components that are also read. Each must exist.
    std::vector<std::string> vector_arrays = {};

    bool must_have_regions() const { return region_array != usual_region_array; }
};

/// Thrown if the format of a file is not known.
struct UnknownFormat : InputError {
    using InputError::InputError;
};

/// True if the text begins with the mark of a mesh format. TetGen files have no mark.
bool begins_like_a_mesh(std::string_view text);

/// The contents of a mesh file.
struct MeshFile {
    topology::MeshData mesh;
    std::vector<std::string> warnings;  ///< one sentence each, without the name of the file
    /// The arrays of ReadOptions::vector_arrays, by name, with one vector a cell of `mesh`. The
    /// values are not checked.
    std::map<std::string, std::vector<Vec3>> cell_vectors = {};
};

/// Reads the tetrahedra, hexahedra, wedges, pyramids and, of VTK files, polyhedra, in the order of
/// the file. Elements of Abaqus are in the order of their numbers.
///
/// The contents of the file decide its format, or else its suffix. Formats: VTU (all encodings),
/// legacy VTK unstructured grids, Gmsh 1, 2 and 4.1, MEDIT (text), TetGen (either file of the pair
/// .node and .ele), Abaqus and CalculiX (see abaqus_reader.h), FEBio (see febio_reader.h),
/// USD as text (see usda_reader.h).
///
/// Vertices, lines and surface cells are left out with a warning. So are the nodes of cells of
/// higher order that are no corners, if ReadOptions::linear is set; the points that are left keep
/// their order. A point array `rest_position` of a VTK file replaces its points. The arrays
/// `carrier`, `carrier_corners` and `carrier_types` of a VTU file become
/// MeshData::carriers. Regions are the cell array of the options, the physical groups
/// of Gmsh, the references of MEDIT, the first attribute of TetGen, or the element sets of
/// Abaqus, FEBio and USD.
///
/// If all cells have negative volume, the order of their corners is reversed, with a warning.
/// Points may coincide (MeshData::points_may_coincide) in frames of runs, with carriers, and in
/// meshes that `incise cut` has written.
///
/// Every count, offset and index is checked before it is used. Memory is proportional to the size
/// of the file, or of the unpacked blocks of a compressed file. The coordinates of the cells are
/// finite. Mesh::build checks the shape of the cells and points that are not joined.
/// Throws UnknownFormat, and InputError that names the file, the line, byte or cell, what was found
/// and a remedy.
MeshFile read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace incise::io
