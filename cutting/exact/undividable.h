// Elements that a cut cannot divide: all that are no tetrahedra.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>

#include "incise/base/error.h"
#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/cutting/tools/tool.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Thrown if a cut would divide an element that is no tetrahedron. The text names the element by
/// its label. Callers add what the user can change.
struct UndividableElement : InputError {
    UndividableElement(const std::string& text, CellId which) : InputError(text), element(which) {}
    CellId element;
};

/// Returns the mode of blades for which nothing else is said: CutMode::split, or CutMode::separate
/// if the mesh has elements that cannot be divided. Cost: O(#elements).
CutMode usual_mode(const topology::Mesh& mesh);

/// Throws UndividableElement for an element.
[[noreturn]] void refuse_to_divide(const topology::Mesh& mesh, CellId e);

/// Returns the element of lowest id that is no tetrahedron and that the surface crosses at rest.
/// Returns nothing if there is none. Cost: O(n), and a test of the edges of such elements near the
/// surface.
std::optional<CellId> first_undividable(const topology::Mesh& mesh, const CutSurface& surface);

/// Elements that are no tetrahedra and that surfaces come near to at rest, without crossing them.
struct NearMisses {
    std::set<CellId> elements;
    CellId nearest;  ///< of these elements; invalid if there are none
    double distance = std::numeric_limits<double>::infinity();  ///< of the nearest, m

    bool is_empty() const { return elements.empty(); }
};

/// Adds the elements to which the surface comes nearer at rest than `margin` times their mean edge
/// length.
/// @pre  first_undividable() finds none
/// Cost: as first_undividable().
void add_near_misses(const topology::Mesh& mesh, const CutSurface& surface, double margin,
                     NearMisses& found);

}  // namespace incise::cutting
