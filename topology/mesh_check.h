// Check of mesh data before a mesh is built from them.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <string>
#include <vector>

#include "incise/topology/mesh_data.h"
#include "incise/topology/source_faces.h"

namespace incise::topology {

/// Two cells that share a face. `shift` is the position in b's face of the point at position 0 of
/// a's face.
struct SharedFace {
    SourceFace a, b;
    int shift = 0;
};

/// A quadrilateral that is joined to two triangles of other cells: see find_joined_quads().
struct JoinedQuad {
    SourceFace quad;
    int first_end = 0;  ///< see Diagonals
    /// The one on the corners from the first end of the diagonal on, then the other.
    std::array<SourceFace, 2> triangles = {};
};

/// The result of check().
struct MeshCheck {
    /// What makes the mesh unusable, in the order found. Of many errors of one kind only the first
    /// few are listed, and the others are counted.
    std::vector<std::string> errors;
    /// What is unusual but does not make the mesh unusable.
    std::vector<std::string> warnings;
    /// The shared faces, in ascending order of `a`. The list is complete only if there are no
    /// errors.
    std::vector<SharedFace> shared_faces;
    /// The quadrilaterals that are joined to two triangles, in ascending order.
    std::vector<JoinedQuad> joined_quads;
};

/// Checks mesh data. Errors are:
/// - lists whose lengths do not fit each other, and indices out of range
/// - no volume cells
/// - coordinates that are not finite
/// - cells with repeated corners, or with zero or negative volume
/// - a corner of a hexahedron, wedge or pyramid that is turned inside out
/// - duplicate cells, and faces that more than two cells share
/// - neighbours on the same side of their face, or twisted against each other, unless one of them
///   is turned inside out, from which this follows
/// - a polyhedron without a carrier, or whose faces do not bound a ball: see fault_of_polyhedron()
/// - carriers that cannot be those of the cells: see fault_of_carriers()
///
/// There are warnings about points that no cell uses, and about points at one position that are not
/// joined (see mesh_repair.h). Messages name cells and points by their numbers from 0 and by their
/// numbers in the source. Those of cells that another order of corners or another kind would mend
/// give it: see cell_advice.h. Cost: O(n), some 0.3 us a cell.
MeshCheck check(const MeshData& data, const WeldAdvice& advice = {});

}  // namespace incise::topology
