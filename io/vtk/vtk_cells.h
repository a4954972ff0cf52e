// Conversion of the cells of VTK's unstructured grids, from XML or legacy files, to a mesh.
// Source: vtkCellType.h of VTK 9.1; "VTK File Formats", VTK User's Guide.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// The arrays of .vtu files that contain topology::Carriers: a cell array of one whole number, and
/// an array of the field data with four positions a tuple. If not all carriers are tetrahedra, a
/// tuple has eight positions, of which those behind the corners are zero, and a further array of
/// the field data has the type of each in VTK.
inline constexpr const char* carrier_array = "carrier";
inline constexpr const char* carrier_corners_array = "carrier_corners";
inline constexpr const char* carrier_types_array = "carrier_types";
/// The array of the field data with Diagonals::bits() of carriers, if any has diagonals.
inline constexpr const char* carrier_diagonals_array = "carrier_diagonals";

/// Returns the cell array of .vtu files that contains topology::MeshData::cut_faces, or entry
/// `list - 1` of further_cut_faces. Its name has the number of its first face: cut_faces_31.
inline std::string cut_faces_array(std::size_t list = 0) {
    return list == 0 ? "cut_faces" : "cut_faces_" + std::to_string(list * topology::max_cut_faces);
}

/// Returns the number of a kind of cell in VTK.
constexpr int vtk_cell_type(topology::CellKind kind) {
    constexpr std::array<int, topology::num_cell_kinds + 1> types = {10, 12, 13, 14, 42};
    return types[static_cast<std::size_t>(kind)];
}
/// Returns the kind of linear cell that has a number in VTK; nothing if Incise has none. The
/// pixels of voxels are in another order.
std::optional<topology::CellKind> kind_of_vtk_cell(std::int64_t type);

/// The arrays of one piece of an unstructured grid. Their lengths are consistent. Their contents
/// are not checked.
struct VtkPiece {
    std::vector<double> coordinates;         ///< three a point
    std::vector<std::int64_t> types;         ///< one a cell
    std::vector<std::int64_t> offsets;       ///< #cells + 1, from 0
    std::vector<std::int64_t> connectivity;  ///< points of the cells
    std::vector<double> regions;             ///< one a cell; if empty, all are 0
    std::vector<std::int64_t> carriers;      ///< one a cell; if empty, all are whole
    /// By list of cut_faces_array(), one a cell; if empty, none is on a cut.
    std::vector<std::vector<std::int64_t>> cut_faces;
    /// The faces of polyhedra: for each its number of faces, then for each face the number of its
    /// points and its points. By cell, where its faces begin and end.
    std::vector<std::int64_t> faces, face_begins, face_ends;
    std::map<std::string, std::vector<double>> vectors;  ///< by name, three numbers a cell
    /// True for a frame of a run, in which the mesh may be cut. Its points have the arrays
    /// rest_position and node_id.
    bool is_frame = false;
};

/// Throws InputError unless the offsets begin with 0 and do not decrease. All offsets are then in
/// range if the last one is. The message begins with `location`.
void check_offsets(const std::vector<std::int64_t>& offsets, const std::string& location);

/// Appends the points, the volume cells and the vectors of a piece. Checks kinds, sizes, point
/// numbers and regions, and throws InputError. Messages begin with `location`: the file, and the
/// piece if there are several.
/// @pre  check_offsets() has passed, and the last offset is connectivity.size(). The faces of a
///       polyhedron are in the range of `faces`.
void append_piece(const VtkPiece& piece, const std::string& location, MeshFile& file,
                  CellCollector& collector);

/// Throws InputError: the file has no cell array `name`, which the user wants as regions. `others`
/// are the cell arrays that could be regions: one whole number a cell.
[[noreturn]] void refuse_missing_regions(const std::string& location, const std::string& name,
                                         const std::vector<std::string>& others);

/// Throws InputError: the file has no cell array `name` of vectors, which the user wants. `others`
/// are the cell arrays of vectors in the file.
[[noreturn]] void refuse_missing_vectors(const std::string& location, const std::string& name,
                                         const std::vector<std::string>& others);

/// Returns the end of a message about a dataset of VTK that holds no volume cells: what it is and
/// what to do. `kind` is its kind in lower case, as in legacy files or in XML.
std::string remedy_for_dataset(std::string_view kind);

/// Makes a collector whose messages have the words of VTK.
CellCollector make_vtk_collector(const std::string& file, const ReadOptions& options);

}  // namespace incise::io
