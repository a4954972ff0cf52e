// The edge of a blade whose path ends inside the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/swept_edge.h"

namespace incise::cutting {

/// The edge of a blade where it stops, with the direction in which it was moving.
class BladeEnd {
  public:
    /// @param edge    a polyline of at least two points, m
    /// @param motion  of each point, of any length; a point without motion goes on as its
    ///                neighbours do
    BladeEnd(std::vector<Vec3> edge, const std::vector<Vec3>& motion);

    const std::vector<Vec3>& edge() const { return edge_; }
    /// Returns the same blade at a place that is farther by `offset`, m.
    BladeEnd moved_by(const Vec3& offset) const {
        BladeEnd moved = *this;
        for (Vec3& x : moved.edge_) x += offset;
        return moved;
    }

    /// Returns how far a point is ahead of the edge, m; negative behind it.
    double distance_ahead(const Vec3& x) const;

    /// Returns the edge after it went straight on. Each of its points moves by `distance`, m,
    /// across the edge.
    std::vector<Vec3> edge_after(double distance) const;
    /// Returns what the edge would sweep on that way.
    SweptEdge continuation(double distance) const { return {edge_, edge_after(distance)}; }

    /// Returns the vector to x from the point of the edge that is nearest to x, m.
    Vec3 away_from_edge(const Vec3& x) const;

  private:
    Vec3 along(std::size_t segment) const;
    double nearest_place(std::size_t segment, const Vec3& x) const;
    Vec3 point_at(std::size_t segment, double place) const;

    std::vector<Vec3> edge_;
    // By point: its motion, of such a length that the part across the edge is 1.
    std::vector<Vec3> ahead_;
};

}  // namespace incise::cutting
