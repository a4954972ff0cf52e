// A cell as the source has it, though quadrilaterals of it are divided where it meets triangles.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "incise/base/types.h"
#include "incise/topology/cell_kind.h"
#include "incise/topology/cell_shape.h"
#include "incise/topology/diagonals.h"

namespace incise::topology {

/// A cell of a kind with a numbering of its own, and the diagonals of its faces.
struct WholeCell {
    CellKind kind = CellKind::tetrahedron;
    std::array<VertexId, max_corners> at{};  ///< only as many as the kind has
    Diagonals diagonals = {};

    std::span<const VertexId> corners() const {
        return std::span(at).first(static_cast<std::size_t>(traits(kind).num_corners));
    }
    /// Returns its faces. A divided one has its number for the triangle from the first end of its
    /// diagonal on. The others follow the faces of the kind, in their order.
    /// @param inside_faces  bit f for face f: see CellShape::is_inside()
    CellShape shape(unsigned inside_faces = 0) const;
};

}  // namespace incise::topology
