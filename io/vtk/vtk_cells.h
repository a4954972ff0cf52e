// Conversion of the cells of VTK's unstructured grids, from XML or legacy files, to a mesh.
// Source: vtkCellType.h of VTK 9.1; "VTK File Formats", VTK User's Guide.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// The arrays of .vtu files that contain topology::Carriers: a cell array of one whole number, and
/// an array of the field data with four positions a tuple.
inline constexpr const char* carrier_array = "carrier";
inline constexpr const char* carrier_corners_array = "carrier_corners";
/// The cell array of .vtu files that contains topology::MeshData::cut_faces.
inline constexpr const char* cut_faces_array = "cut_faces";

/// The arrays of one piece of an unstructured grid. Their lengths are consistent. Their contents
/// are not checked.
struct VtkPiece {
    std::vector<double> coordinates;                     ///< three a point
    std::vector<std::int64_t> types;                     ///< one a cell
    std::vector<std::int64_t> offsets;                   ///< #cells + 1, from 0
    std::vector<std::int64_t> connectivity;              ///< points of the cells
    std::vector<double> regions;                         ///< one a cell; if empty, all are 0
    std::vector<std::int64_t> carriers;                  ///< one a cell; if empty, all are whole
    std::vector<std::int64_t> cut_faces;                 ///< one a cell; if empty, none is on a cut
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
/// @pre  check_offsets() has passed, and the last offset is connectivity.size()
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
