// The cells of VTK's unstructured grids, in XML or legacy files, turned into a mesh.
// Source: vtkCellType.h of VTK 9.1; "VTK File Formats", VTK User's Guide.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "incise/io/mesh/cell_form.h"
#include "incise/io/mesh/mesh_reader.h"
#include "incise/topology/mesh_data.h"

namespace incise::io {

/// The arrays of one piece of an unstructured grid, with lengths that fit one another and
/// contents unchecked.
struct VtkPiece {
    std::vector<double> coordinates;                     ///< three a point
    std::vector<std::int64_t> types;                     ///< one a cell
    std::vector<std::int64_t> offsets;                   ///< #cells + 1, from 0
    std::vector<std::int64_t> connectivity;              ///< points of the cells
    std::vector<double> regions;                         ///< one a cell, or empty: all 0
    std::map<std::string, std::vector<double>> vectors;  ///< by name, three numbers a cell
    /// A frame of a run, which may have been cut: points have a rest_position and a node_id.
    bool is_frame = false;
};

/// Throws InputError unless offsets ascend from 0: then all are in range if the last is.
/// `location` is what the message begins with.
void check_offsets(const std::vector<std::int64_t>& offsets, const std::string& location);

/// Appends the points, the volume cells and their vectors of the piece; checks kinds, sizes, point
/// numbers and regions. `location` is what messages begin with: the file, and the piece if there
/// are several.
/// @pre check_offsets has passed, and the last offset is connectivity.size()
void append_piece(const VtkPiece& piece, const std::string& location, MeshFile& file,
                  CellCollector& collector);

/// Throws InputError: the file has no cell array `name`, which was asked for. `others` are those
/// from which regions could be taken: of whole numbers, one a cell.
[[noreturn]] void refuse_missing_regions(const std::string& location, const std::string& name,
                                         const std::vector<std::string>& others);

/// Throws InputError: the file has no cell array `name` of vectors, which was asked for. `others`
/// are those that it has.
[[noreturn]] void refuse_missing_vectors(const std::string& location, const std::string& name,
                                         const std::vector<std::string>& others);

/// A collector with VTK's words.
CellCollector make_vtk_collector(const std::string& file);

}  // namespace incise::io
