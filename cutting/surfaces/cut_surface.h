// What a cut follows: where it passes through the edges of a mesh.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "incise/base/types.h"
#include "incise/cutting/surfaces/space_time.h"
#include "incise/cutting/surfaces/tissue_motion.h"

namespace incise::cutting {

/// Two surfaces of one identity that pass through the same point in the same direction are the
/// same everywhere. `no_identity` says nothing.
using SurfaceIdentity = std::uint64_t;
inline constexpr SurfaceIdentity no_identity = 0, identity_of_planes = 1;

/// A surface at rest cuts tissue as it is after the step; a moving edge, what it meets during the
/// step. All answers are exact up to the places, and agree with each other: round any triangle of
/// tissue the crossings are even in number, unless the boundary of the surface runs through it.
class CutSurface {
  public:
    virtual ~CutSurface() = default;

    /// False only if the surface is nowhere in the box.
    virtual bool may_meet(const Box& box) const = 0;
    /// False only if the surface is nowhere in the convex hull of the points in their motion: a
    /// closer look where it is in their box.
    virtual bool may_meet_hull(std::span<const MovingPoint>) const { return true; }
    /// Appends where the surface passes through the segment from a to b, in no order. The same
    /// segment is always asked for in the same direction.
    virtual void append_crossings(const MovingPoint& a, const MovingPoint& b,
                                  std::vector<Crossing>& crossings) const = 0;
    /// Distance of a point from the surface, m; not a number if the surface is flat near all
    /// crossings, so that its planes tell.
    virtual double distance(const Vec3&) const { return std::numeric_limits<double>::quiet_NaN(); }
    /// Whether it may turn sharply within an element and is there all at once. Not so if it is
    /// swept: what is decided at creases would depend on the steps.
    virtual bool has_creases() const { return false; }
    /// Normal, of unit length, of a surface with creases where it is no farther from the point than
    /// `distance`, m, and its boundary is; nothing else.
    virtual std::optional<Vec3> normal_near(const Vec3&, double /*distance*/) const {
        return std::nullopt;
    }
    virtual SurfaceIdentity identity() const { return no_identity; }
    /// Whether the boundary at which a sweep ends, and the next one begins, runs through the
    /// triangle (as it is after the step), an odd number of times. Exact, and in agreement with the
    /// crossings of this step and the next. Nothing if the surface is not swept.
    virtual std::optional<bool> ends_inside(const std::array<MovingPoint, 3>&) const {
        return std::nullopt;
    }
    /// Whether the cut, if it goes on, does so from within `reach` of the point (as it is after the
    /// step).
    virtual bool ends_near(const Vec3&, double /*reach*/) const { return true; }
};

}  // namespace incise::cutting
