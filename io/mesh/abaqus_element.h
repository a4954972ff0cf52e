// The element types of Abaqus and CalculiX.
// Source: Abaqus 6.14 Analysis User's Guide, part VI; CalculiX CrunchiX 2.20 user's manual, 6.2.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

#include "incise/io/mesh/cell_form.h"

namespace incise::io {

/// Returns the form of an element type, given in upper case, such as C3D8R. Letters after the
/// number of nodes (integration, hybrid, ...) are ignored. Returns null for an unknown type.
const CellForm* abaqus_form(std::string_view type);

}  // namespace incise::io
