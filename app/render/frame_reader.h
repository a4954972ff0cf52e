// One frame with all its fields, read by VTK's reader but not trusted.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include "incise/app/render/frame_list.h"

namespace incise::render {

/// Throws InputError if the file is missing, cut short, or not a sound unstructured grid.
vtkSmartPointer<vtkUnstructuredGrid> read_frame(const std::filesystem::path& path);

/// The time that the grid's field data hold, if any.
std::optional<double> time_of(vtkUnstructuredGrid& grid);

}  // namespace incise::render
