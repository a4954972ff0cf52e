// Decides which faces open along a cut, and which stay joined because of sliver fragments.
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

/// The faces to open, and the small components that stay joined.
struct Separation {
    std::vector<FaceId> faces;       ///< to open
    std::vector<ElementId> slivers;  ///< elements of sliver fragments
    std::vector<ElementId> waiting;  ///< not decided yet: see CutFront::waiting()
};

/// The times at which the surface comes to faces of the mesh, and where its sweep ends.
struct Course {
    /// Returns the time in the step of the last event that separates the elements of a face.
    std::function<double(FaceId)> time_of_separation;
    /// True if the boundary at which the sweep ends passes through the face.
    std::function<bool(FaceId)> ends_in;
};

/// Returns the faces between the two sides (Sides::separated_faces()). Faces between frozen nodes
/// (CutFront::freeze()) and faces of sliver fragments stay joined.
///
/// Sliver fragments are small groups of elements that snapping leaves connected to their side by
/// nodes only. They stay with the other side: by the face to which the surface comes last, or by
/// all faces to which it comes at once. While the boundary of the cut is at one of their nodes, it
/// is not known whether they are connected to their side, and they wait. So the number of steps of
/// a blade does not matter.
/// @param mesh          during the edit
/// @param front         of the cut
/// @param snap_history  has the sliver fragments of earlier cuts
/// @param touched       the elements to look at: all that the edit has changed, and possibly others
/// @param place_on_cut  see Sides
/// @param is_reached    whether a face between the sides may open; if empty, all may
/// @param course        nothing if no sliver fragments can arise, as without snapping
Separation separation(const topology::Mesh& mesh, const CutFront& front,
                      const SnapHistory& snap_history, const std::vector<ElementId>& touched,
                      const PlaceOnCut& place_on_cut, const std::function<bool(FaceId)>& is_reached,
                      const std::optional<Course>& course);

}  // namespace incise::cutting
