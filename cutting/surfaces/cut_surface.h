// The interface of cut surfaces: where a surface passes through the edges of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/space_time.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// Identifies a surface. Two surfaces of one identity that pass through the same point in the same
/// direction are the same surface. A surface with `no_identity` is not recognized as any other.
using SurfaceIdentity = std::uint64_t;
inline constexpr SurfaceIdentity no_identity = 0, identity_of_planes = 1;

/// A surface that a cut follows. A surface at rest intersects the tissue where the tissue is after
/// the step. A swept surface intersects the tissue during the step, while both move.
///
/// All decisions are exact and agree with each other; positions are rounded. The number of
/// intersections with the sides of a triangle of tissue is even, unless the boundary of the surface
/// passes through the triangle.
class CutSurface {
  public:
    virtual ~CutSurface() = default;

    /// Returns false only if no part of the surface is in the box.
    virtual bool may_meet(const Box& box) const = 0;
    /// Returns false only if no part of the surface is in the convex hull of the points during
    /// their motion. This test is finer than the one with the box of the points.
    virtual bool may_meet_hull(std::span<const MovingPoint>) const { return true; }
    /// Appends the intersections with the segment from a to b, in no particular order.
    /// @pre  all calls for the same segment have the same direction
    virtual void append_crossings(const MovingPoint& a, const MovingPoint& b,
                                  std::vector<Crossing>& crossings) const = 0;
    /// True if the surface may turn sharply within an element and is there as a whole at once.
    /// False for swept surfaces, since decisions at their creases would depend on the steps.
    virtual bool has_creases() const { return false; }
    /// Returns the unit normal of a surface with creases, at its point nearest to the given one.
    /// Returns nothing if the surface is farther away than `distance`, m, or if its boundary is not
    /// farther.
    virtual std::optional<Vec3> normal_near(const Vec3&, double /*distance*/) const {
        return std::nullopt;
    }
    /// True if a surface that is there as a whole at once comes within `distance`, m, of a point.
    virtual bool comes_within(const Vec3&, double /*distance*/) const { return true; }
    virtual SurfaceIdentity identity() const { return no_identity; }
    /// True if an edge that moves, as that of a blade, makes the surface during the step.
    virtual bool is_swept() const { return false; }
    /// True if the boundary at which a sweep ends, and the next one begins, passes through a
    /// triangle an odd number of times. The triangle is that after the step. The result is exact
    /// and agrees with the intersections of this step and the next. Returns nothing if the surface
    /// is not swept.
    virtual std::optional<bool> ends_inside(const std::array<MovingPoint, 3>&) const {
        return std::nullopt;
    }
    /// Returns a point of the triangle where the boundary does so, m.
    virtual std::optional<Vec3> end_point_inside(const std::array<MovingPoint, 3>&) const {
        return std::nullopt;
    }
    /// Returns false only if the cut does not go on within `radius`, m, of a point. The point is
    /// that after the step.
    virtual bool ends_near(const Vec3&, double /*radius*/) const { return true; }
};

}  // namespace incise::cutting
