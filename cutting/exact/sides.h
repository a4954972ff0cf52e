// Which side of a cut elements are on, and which faces lie between the two.
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

/// Where an element is all of whose corners are on the cut, if the surface tells.
using PlaceOnCut = std::function<std::optional<CutFront::Place>(ElementId)>;

/// Where an element is, see CutFront::place_of; one of which it is not known goes with the
/// neighbour with which it shares the largest face.
class Sides {
  public:
    /// @param touched  the elements to look at, and thereby their faces
    /// @param place_on_cut  asked first, or empty
    Sides(const topology::Mesh& mesh, const CutFront& front, const std::vector<ElementId>& touched,
          const PlaceOnCut& place_on_cut);

    /// Joined faces, each from its lower side and in ascending order, whose three nodes lie on the
    /// cut and whose elements are on different sides of it, all three nodes agreeing; at the front,
    /// where the cut ends, they do not agree yet.
    std::vector<FaceId> separated_faces() const;

    /// Whether it is known where the element is.
    bool is_placed(ElementId e) const { return place(e).has_value(); }
    /// Whether the way from where the placed element lies to its corner `n`, on the cut, crosses
    /// it.
    bool is_crossed_to(ElementId e, NodeId n) const;

  private:
    using Place = CutFront::Place;

    void collect_faces(const std::vector<ElementId>& touched);
    void place_elements_on_cut();
    bool is_on_cut(FaceId f) const;
    NodeId far_corner(ElementId e) const;
    std::optional<Place> place(ElementId e) const;
    bool is_separated(FaceId f) const;

    const topology::Mesh& mesh_;
    const CutFront& front_;
    const PlaceOnCut& place_on_cut_;
    std::vector<FaceId> faces_;  // joined, on the cut, from their lower side
    // Of elements all of whose corners are on the cut.
    std::unordered_map<ElementId, Place> places_;
};

}  // namespace incise::cutting
