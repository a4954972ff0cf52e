// Which faces part the two sides of a cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "cutting/cut_front.h"
#include "cutting/scars.h"
#include "topology/mesh.h"
#include "topology/types.h"

namespace incise::cutting {

/// What to open, and what stays joined all the same.
struct Parting {
    std::vector<topology::FaceId> faces;
    std::vector<topology::ElementId> crumbs;
};

/// Joined faces, each from its lower side and in ascending order, whose three nodes lie on the cut
/// and whose elements are on different sides of it, all three nodes agreeing; at the front, where
/// the cut ends, they do not agree yet. Not those between settled nodes (CutFront::settle).
///
/// Where an element is, see CutFront::place_of; one of which it is not known goes with the
/// neighbour with which it shares the largest face. Small groups that
/// hang on the rest of their side by nodes only, which snapping may leave, stay with the other
/// side: they would be crumbs.
///
/// @param keep_crumbs  whether there are crumbs: an exact cut leaves none
/// @param touched  the elements to look at, and thereby their faces
Parting parted_faces(const topology::Mesh& mesh, const CutFront& front, const Scars& scars,
                     const std::vector<topology::ElementId>& touched, bool keep_crumbs);

}  // namespace incise::cutting
