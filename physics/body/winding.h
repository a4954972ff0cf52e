// Bodies that are wound up: every element in order, but more of them round an edge than there is
// room for.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>
#include <span>

#include "incise/topology/mesh.h"

namespace incise::physics {

/// Edges of tetrahedra round which dihedral angles add up to more than one and a half turns: inside
/// a body they make whole turns, so two there. Elements lie in each other then, though none need be
/// inverted, and no law of an element's own strain undoes it. Lips of a cut that overlap, which
/// nothing keeps apart, make somewhat more than one turn round the cut's end and are not meant.
struct Winding {
    std::size_t num_edges = 0;
    ElementId element;  ///< the one of the lowest id at such an edge; if there are any
};

/// At the given positions (m, by node id). Edges of other kinds of cells, and of flat or inverted
/// elements, are left out. Cost: O(#elements log #elements).
Winding find_winding(const topology::Mesh& mesh, std::span<const Vec3> positions);

}  // namespace incise::physics
