// Detection of bodies that are wound up: no element is inverted, but the elements at an edge go
// round it twice. See docs/theory.md, Beyond inversion.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/topology/mesh.h"

namespace incise::physics {

/// The edges of tetrahedra at which the dihedral angles add up to more than one and a half turns.
///
/// Inside a body the sum is a whole number of turns, so it is two turns at such an edge. Elements
/// then overlap, although none of them needs to be inverted. No law can undo this, since a law
/// depends only on the strain of one element. The faces of a cut may also overlap, as there is no
/// contact. This gives somewhat more than one turn at the cut front, which is below the limit.
struct Winding {
    std::size_t num_edges = 0;
    CellId element;  ///< with the lowest id at such an edge; invalid if there is no edge
};

/// Returns the winding at the given positions (m, by node id). Edges of flat or inverted elements
/// and of other kinds of cells are left out. Cost: O(#elements log #elements).
Winding find_winding(const topology::Mesh& mesh, std::span<const Vec3> positions);

}  // namespace incise::physics
