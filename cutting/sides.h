// Which faces part the two sides of a cut.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
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
    std::vector<topology::ElementId> waiting;  ///< see CutFront::waiting
};

/// How the surface has come to the faces of the mesh.
struct Course {
    /// When the last of what parts the face came about.
    std::function<double(topology::FaceId)> time_of_parting;
    /// Whether the border at which the sweep has ended runs through the face.
    std::function<bool(topology::FaceId)> ends_in;
};

/// Joined faces, each from its lower side and in ascending order, whose three nodes lie on the cut
/// and whose elements are on different sides of it, all three nodes agreeing; at the front, where
/// the cut ends, they do not agree yet. Not those between settled nodes (CutFront::settle).
///
/// Where an element is, see CutFront::place_of; one of which it is not known goes with the
/// neighbour with which it shares the largest face. Small groups that
/// hang on the rest of their side by nodes only, which snapping may leave, stay with the other
/// side: they would be crumbs. They do so by the face that the surface comes to last, or by all
/// of them if it comes to them at once; so it does not matter how many steps a blade takes.
///
/// @param touched  the elements to look at, and thereby their faces
/// @param course  nothing if there are no crumbs: an exact cut leaves none
Parting parted_faces(const topology::Mesh& mesh, const CutFront& front, const Scars& scars,
                     const std::vector<topology::ElementId>& touched,
                     const std::optional<Course>& course);

}  // namespace incise::cutting
