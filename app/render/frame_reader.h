// Reads a frame with all its fields by the reader of VTK, and checks the file and the result.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include "incise/app/render/frame_list.h"

namespace incise::render {

/// Reads a frame. Throws InputError if the file is missing, truncated, or not a sound unstructured
/// grid.
vtkSmartPointer<vtkUnstructuredGrid> read_frame(const std::filesystem::path& path);

/// Returns the time in the field data of the grid, s, if there is one.
std::optional<double> time_of(vtkUnstructuredGrid& grid);

}  // namespace incise::render
