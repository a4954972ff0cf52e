// What Abaqus and CalculiX call their elements.
// Source: Abaqus 6.14 Analysis User's Guide, part VI; CalculiX CrunchiX 2.20 user's manual, 6.2.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string_view>

#include "incise/io/mesh/cell_form.h"

namespace incise::io {

/// What is known of an element type, in upper case, such as C3D8R; null if nothing is. Letters
/// behind the number of nodes (integration, hybrid, ...) do not matter.
const CellForm* abaqus_form(std::string_view type);

}  // namespace incise::io
