// The sides of a cut on which elements are, and the faces between the two sides.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <unordered_map>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/exact/cut_front.h"
#include "incise/topology/mesh.h"

namespace incise::cutting {

/// Returns the side of an element whose corners are all on the cut, or nothing if the surface does
/// not decide it.
using PlaceOnCut = std::function<std::optional<CutFront::Place>(CellId)>;

/// Holds the sides of elements: see CutFront::place_of(). An element whose side is not known has
/// that of the neighbour with which it shares the largest face.
/// @lifetime  mesh, front and place_on_cut must outlive the object
class Sides {
  public:
    /// @param mesh          during the edit
    /// @param front         of the cut
    /// @param touched       the elements to look at, with their faces
    /// @param place_on_cut  called before CutFront::place_of(); may be empty
    Sides(const topology::Mesh& mesh, const CutFront& front, const std::vector<CellId>& touched,
          const PlaceOnCut& place_on_cut);

    /// Returns the joined faces between the two sides, in ascending order, each with its lower id.
    ///
    /// The three nodes of such a face are on the cut, and its elements are on different sides by
    /// all three nodes. At the front, where the cut ends, the three nodes do not agree yet.
    std::vector<FaceId> separated_faces() const;

    /// True if the side of the element is known.
    bool is_placed(CellId e) const { return place(e).has_value(); }
    /// True if the path from an element to its corner `n` on the cut crosses the cut.
    /// @pre  is_placed(e)
    bool is_crossed_to(CellId e, VertexId n) const;

  private:
    using Place = CutFront::Place;

    void collect_faces(const std::vector<CellId>& touched);
    void place_elements_on_cut();
    bool is_on_cut(FaceId f) const;
    VertexId far_corner(CellId e) const;
    std::optional<Place> place(CellId e) const;
    bool is_separated(FaceId f) const;

    const topology::Mesh& mesh_;
    const CutFront& front_;
    const PlaceOnCut& place_on_cut_;
    std::vector<FaceId> faces_;  // joined, on the cut, each with its lower id
    // Of elements all of whose corners are on the cut.
    std::unordered_map<CellId, Place> places_;
};

}  // namespace incise::cutting
