// The surface of a body as triangles, which follows edits.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/change_set.h"
#include "incise/topology/follower.h"
#include "incise/topology/mesh.h"

namespace incise::topology {

/// The triangles of all faces that have no neighbour; a quadrilateral makes two. Their nodes index
/// the positions of the body and run anticlockwise seen from outside.
///
/// Triangles have slots in a list without gaps. An edit changes some slots and the length of the
/// list; take_changes() names them, so that a renderer uploads no more than these.
class BoundarySurface {
  public:
    /// Cost: a look at each face.
    explicit BoundarySurface(const Mesh& mesh);

    /// Follows an edit. Throws InputError for an edit out of turn.
    /// @param mesh after the edit
    /// Cost: proportional to the elements that the edit touches.
    void apply(const Mesh& mesh, const ChangeSet& changes);

    /// Shape (T, 3).
    std::span<const std::array<NodeId, 3>> triangles() const { return triangles_; }
    /// The face of the mesh that each triangle is of. Shape (T).
    std::span<const FaceId> faces() const { return faces_; }
    /// 1 for a triangle of the face of a cut: it lay inside the body at first; else 0. Shape (T).
    std::span<const std::uint8_t> is_cut() const { return is_cut_; }

    /// The epoch of the mesh that the surface is of.
    std::uint64_t version() const { return epoch_.value(); }
    /// Returns the slots that have changed since the last call, in ascending order, at first all
    /// of them. Places from triangles().size() on are gone.
    std::vector<std::size_t> take_changes();

  private:
    void add_faces(const Mesh& mesh, ElementId e);
    void remove_faces(ElementId e);

    std::vector<std::array<NodeId, 3>> triangles_;
    std::vector<FaceId> faces_;
    std::vector<std::uint8_t> is_cut_;
    std::unordered_map<ElementId, std::vector<std::size_t>> slots_;  // of an element's triangles
    std::vector<std::size_t> changed_;
    FollowedEpoch epoch_;
};

}  // namespace incise::topology
