// The colours of a body that no field colours: tissue by region, and the faces of cuts.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace incise::render {

/// The name of the array that add_tissue_look() adds.
inline constexpr const char* look_array = "incise look";

/// Adds a colour to each polygon of the surface of a frame. Without the array "region" the body has
/// one colour; without "cut_faces" no face is on a cut.
/// @pre  the surface has the original ids of its points and cells
void add_tissue_look(vtkUnstructuredGrid& grid, vtkPolyData& surface);
/// Adds a paler colour to each polygon of a section through a frame.
/// @pre  the section has the arrays of cells of the frame
void add_section_look(vtkUnstructuredGrid& grid, vtkPolyData& section);

}  // namespace incise::render
