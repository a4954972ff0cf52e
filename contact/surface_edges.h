// The edges of a surface: which are sharp, and in which others they go on.
// Source: docs/theory.md, Contact.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/contact/surface_tree.h"

namespace incise::contact {

/// The number of no edge.
inline constexpr std::uint32_t no_edge = 0xffffffff;

/// An edge at which two triangles of a surface meet.
struct SurfaceEdge {
    std::array<VertexId, 2> nodes;           ///< in ascending order
    std::array<std::uint32_t, 2> triangles;  ///< that meet at it
    bool is_sharp;                           ///< at rest it is convex, and its triangles turn
    /// By end, the sharp edge that goes on there, or no_edge. An edge that is not sharp has none.
    std::array<std::uint32_t, 2> next{no_edge, no_edge};

    /// True, by end, where no other edge goes on.
    std::array<bool, 2> ends() const { return {next[0] == no_edge, next[1] == no_edge}; }
};

/// Returns the normal of a triangle, outward, of the length of twice its area, m2; zero if
/// it has none but for rounding.
/// @param x  positions by vertex id, m
Vec3 area_of(const Triangle& triangle, std::span<const Vec3> x);

/// The edges of a surface, in ascending order of their nodes.
class SurfaceEdges {
  public:
    /// Takes the edges of triangles. Cost: O(n log n).
    /// @param rest_positions  by vertex id, m: they tell which edges are sharp
    void set_triangles(std::span<const Triangle> triangles, std::span<const Vec3> rest_positions);

    const SurfaceEdge& operator[](std::uint32_t edge) const { return edges_[edge]; }
    std::size_t size() const { return edges_.size(); }
    /// Returns the numbers of the edges of a triangle; no_edge where it meets no other one.
    const std::array<std::uint32_t, 3>& of_triangle(std::size_t t) const { return of_triangle_[t]; }
    /// Returns the number of the edge between two nodes, in ascending order, or no_edge.
    std::uint32_t find(const std::array<VertexId, 2>& nodes) const;

  private:
    void list(std::span<const Triangle> triangles, std::span<const Vec3> X);
    void join(std::span<const Vec3> rest_positions);

    std::vector<SurfaceEdge> edges_;
    std::vector<std::array<std::uint32_t, 3>> of_triangle_;
};

}  // namespace incise::contact
