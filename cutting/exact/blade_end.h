// Where the way of a blade ends inside the body.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/swept_edge.h"

namespace incise::cutting {

/// The edge of a blade where it stops, and the direction in which it was moving.
class BladeEnd {
  public:
    /// @param edge    a polyline of at least two points, m
    /// @param motion  of each point, of any length; a point without goes on as its neighbours do
    BladeEnd(std::vector<Vec3> edge, const std::vector<Vec3>& motion);

    const std::vector<Vec3>& edge() const { return edge_; }

    /// How far the point is ahead of the edge, m; negative behind it.
    double distance_ahead(const Vec3& x) const;

    /// What the edge would sweep if it went straight on, each of its points by this distance (m)
    /// across the edge.
    SweptEdge continuation(double distance) const;

    /// From its point that is nearest to x.
    Vec3 away_from_edge(const Vec3& x) const;

  private:
    Vec3 along(std::size_t segment) const;
    double nearest_place(std::size_t segment, const Vec3& x) const;
    Vec3 point_at(std::size_t segment, double place) const;

    std::vector<Vec3> edge_;
    std::vector<Vec3> ahead_;  // by point: its motion, as long as it takes to get 1 across the edge
};

}  // namespace incise::cutting
