// A body cut open in its picture by a plane.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vtkBoundingBox.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

#include <optional>
#include <string_view>
#include <variant>

#include "incise/base/types.h"

namespace incise::render {

/// A plane of current positions. What is in front of it, as the eye sees it, is not drawn.
struct SectionPlane {
    Vec3 point, normal;
};

/// A plane across an axis, in the middle of all frames.
struct MiddlePlane {
    int axis;
};

using Section = std::variant<SectionPlane, MiddlePlane>;

/// Parses x, y or z; x=0.02 and so on; or six numbers, those of a point and of a normal. Returns
/// nullopt for anything else.
std::optional<Section> parse_section(std::string_view text);

/// Returns the plane, with the normal towards the eye.
/// @param bounds  of all frames
/// @param view    from the body to the eye
SectionPlane place(const Section& section, const vtkBoundingBox& bounds, const Vec3& view);

/// Replaces the surface of a frame by what lies behind the plane, and adds the section itself. The
/// section has the arrays of the frame, and the look of tissue that is cut open.
void cut_open(vtkUnstructuredGrid& grid, const SectionPlane& plane, vtkPolyData& surface);

}  // namespace incise::render
