// The surface that a body had before any edit, in the body as it is: by nodes alone, without
// positions and without the marks of the mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "incise/topology/change_set.h"
#include "incise/topology/mesh.h"

namespace incise::test {

/// Follows a mesh from before its first edit.
class FirstSurface {
  public:
    explicit FirstSurface(const topology::Mesh& mesh);
    void apply(const topology::ChangeSet& changes);

    /// True if a face is on the boundary, but not a part of the first surface.
    bool is_on_cut(const topology::Mesh& mesh, FaceId face) const;
    /// Returns the faces at which the mesh says otherwise.
    std::vector<FaceId> faults(const topology::Mesh& mesh) const;

  private:
    using Nodes = std::vector<VertexId>;        // ascending
    std::vector<Nodes> first_nodes_;            // by node, those before any edit that it is between
    std::vector<CellId> ancestors_;             // by element
    std::vector<std::vector<Nodes>> boundary_;  // by element before any edit, its boundary faces
};

}  // namespace incise::test
