// Which kind of cell a volume of a linear cell complex is. Internal to topology.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "incise/topology/cell_kind.h"
#include "incise/topology/linear_cell_complex.h"

namespace incise::topology {

/// A volume as a cell of a kind with a numbering of its own.
struct VolumeOfKind {
    CellKind kind = CellKind::tetrahedron;
    /// By corner, in the order of cell_kind.h, a dart that starts there.
    std::vector<LinearCellComplex::Dart_const_handle> corners;
};

/// Returns the volume as a tetrahedron, hexahedron, wedge or pyramid of which info.diagonals divide
/// quadrilaterals; nothing if it is none. Its faces are taken to run anticlockwise as seen from
/// outside.
/// @param darts  all of the volume; the first one that fits becomes the first of the cell. The one
///               that info.first_edge names goes before.
/// @pre  each dart has a vertex attribute
std::optional<VolumeOfKind> volume_of_kind(
    const LinearCellComplex& complex, std::span<const LinearCellComplex::Dart_const_handle> darts,
    const ComplexCell& info);

}  // namespace incise::topology
