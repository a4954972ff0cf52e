// The surface of a body as a page draws it.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/topology/boundary_surface.h"
#include "incise/topology/mesh.h"

namespace incise::live {

/// Triangles over vertices of their own. A node has a vertex for its skin and one for its faces of
/// cuts, and one for each region that it is on: so a picture has crisp edges at the lips of a cut
/// and between regions.
class DisplayMesh {
  public:
    /// A vertex of a face of a cut has this bit in its tag. The other bits are the place of its
    /// region in regions().
    static constexpr std::uint32_t is_cut = 0x80000000u;

    /// @param mesh  the body at first; its regions are all that there will be
    explicit DisplayMesh(const topology::Mesh& mesh);

    /// Takes over the triangles of a surface. Cost: O(#triangles).
    void update(const topology::BoundarySurface& surface, const topology::Mesh& mesh);

    std::span<const std::array<std::uint32_t, 3>> triangles() const { return triangles_; }
    /// Returns the node of each vertex.
    std::span<const VertexId> nodes() const { return nodes_; }
    std::span<const std::uint32_t> tags() const { return tags_; }
    /// Returns an element at each vertex, to take the results of.
    std::span<const CellId> elements() const { return elements_; }
    /// Returns the numbers of the regions of the body, ascending.
    std::span<const int> regions() const { return regions_; }

  private:
    std::uint32_t vertex(VertexId n, std::uint32_t tag, CellId e);

    std::vector<int> regions_;
    std::vector<std::array<std::uint32_t, 3>> triangles_;
    std::vector<VertexId> nodes_;
    std::vector<std::uint32_t> tags_;
    std::vector<CellId> elements_;
    // Vertices of a node are a list: the first by node, and the next by vertex.
    static constexpr std::uint32_t none = 0xffffffffu;
    std::vector<std::uint32_t> first_, next_;
};

}  // namespace incise::live
