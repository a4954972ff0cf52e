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

/// The triangles of all faces that have no neighbour. A quadrilateral gives two triangles. The node
/// ids of a triangle index the positions of the body and run anticlockwise as seen from outside.
///
/// Triangles have slots in a list without gaps. An edit changes some slots and the length of the
/// list. take_changes() returns these slots, so that a renderer can upload only them.
class BoundarySurface {
  public:
    /// Builds the surface of `mesh`. Cost: O(#faces).
    explicit BoundarySurface(const Mesh& mesh);

    /// Follows an edit. Throws InputError for an edit out of turn.
    /// @param mesh     the mesh after the edit
    /// @param changes  the edit
    /// Cost: proportional to the elements that the edit touches.
    void apply(const Mesh& mesh, const ChangeSet& changes);

    /// Returns the node ids of each triangle. Shape (T, 3).
    std::span<const std::array<VertexId, 3>> triangles() const { return triangles_; }
    /// Returns the face of the mesh that each triangle belongs to. Shape (T).
    std::span<const FaceId> faces() const { return faces_; }
    /// Returns 1 for each triangle of a face on a cut, else 0; see Mesh::is_on_cut(). Shape (T).
    std::span<const std::uint8_t> is_cut() const { return is_cut_; }

    /// Returns the epoch of the mesh that this surface belongs to.
    std::uint64_t version() const { return epoch_.value(); }
    /// Returns the slots that have changed since the last call, in ascending order; the first call
    /// returns all slots. Slots from triangles().size() on no longer exist.
    std::vector<std::size_t> take_changes();

  private:
    void add_faces(const Mesh& mesh, CellId e);
    void remove_faces(CellId e);

    std::vector<std::array<VertexId, 3>> triangles_;
    std::vector<FaceId> faces_;
    std::vector<std::uint8_t> is_cut_;
    std::unordered_map<CellId, std::vector<std::size_t>> slots_;  // of an element's triangles
    std::vector<std::size_t> changed_;
    FollowedEpoch epoch_;
};

}  // namespace incise::topology
