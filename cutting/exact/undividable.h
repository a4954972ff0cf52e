// Elements that a cut cannot divide: all but tetrahedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>

#include "incise/base/error.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// A cut that is to divide elements has met one that it cannot divide. The text names the element;
/// the remedy is the caller's, who knows what the user has asked for.
struct UndividableElement : InputError {
    using InputError::InputError;
};

/// Throws UndividableElement.
[[noreturn]] void refuse_to_divide(const topology::Mesh& mesh, ElementId e);

/// The element of lowest id that the surface crosses where the mesh is at rest and that is no
/// tetrahedron; nothing if there is none. Cost: O(#elements), and of those that are no tetrahedra
/// and that the surface may meet a look at their edges.
std::optional<ElementId> first_undividable(const topology::Mesh& mesh, const CutSurface& surface);

/// Elements that surfaces do not cross at rest and that are not tetrahedra, but that they come near
/// to.
struct NearMisses {
    std::set<ElementId> elements;
    ElementId nearest;                                          ///< one of them, if there are any
    double distance = std::numeric_limits<double>::infinity();  ///< of the nearest, m

    bool is_empty() const { return elements.empty(); }
};

/// Adds the elements that the surface comes nearer to than `margin` times the mean length of their
/// edges, where the mesh is at rest.
/// @pre  first_undividable() finds none
/// Cost: as first_undividable().
void add_near_misses(const topology::Mesh& mesh, const CutSurface& surface, double margin,
                     NearMisses& found);

}  // namespace incise::cutting
