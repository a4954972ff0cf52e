// Which faces open along a cut, and which stay joined lest slivers come off.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/cutting/exact/sides.h"
#include "incise/cutting/exact/snap_history.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// What to open, and what stays joined all the same.
struct Separation {
    std::vector<FaceId> faces;
    std::vector<ElementId> slivers;
    std::vector<ElementId> waiting;  ///< see CutFront::waiting
};

/// How the surface has come to the faces of the mesh.
struct Course {
    /// When the last of what parts the face came about.
    std::function<double(FaceId)> time_of_separation;
    /// Whether the boundary at which the sweep has ended runs through the face.
    std::function<bool(FaceId)> ends_in;
};

/// The faces that part the two sides (Sides::separated_faces), without those between settled nodes
/// (CutFront::settle) and those of slivers.
///
/// SliverFragments are small groups of elements that hang on the rest of their side by nodes only,
/// which snapping may leave. They stay with the other side: by the face to which the surface comes
/// last, or by all of those to which it comes at once. While the boundary of the cut is at one of
/// their nodes it is not known whether they hang on anything, and they wait. So it does not matter
/// how many steps a blade takes.
///
/// @param touched  the elements to look at: all that the edit has changed, and any besides
/// @param place_on_cut  see Sides
/// @param is_reached  whether a face that parts the two sides is to open at all; empty: all are
/// @param course  nothing if there are no slivers: an exact cut leaves none
Separation separation(const topology::Mesh& mesh, const CutFront& front,
                      const SnapHistory& snap_history, const std::vector<ElementId>& touched,
                      const PlaceOnCut& place_on_cut, const std::function<bool(FaceId)>& is_reached,
                      const std::optional<Course>& course);

}  // namespace incise::cutting
