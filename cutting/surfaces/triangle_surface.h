// A cut surface of triangles, open or closed.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>

#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/topology/surface_data.h"

namespace incise::cutting {

/// A triangulated surface at rest. Two triangles at an edge use the same points there, so no gap is
/// between them, and a closed surface frees its inside. Triangles without area cut nothing.
class TriangleSurface final : public CutSurface {
  public:
    /// Cost: O(n log n).
    explicit TriangleSurface(const topology::SurfaceData& surface);
    ~TriangleSurface() override;

    bool may_meet(const Box& box) const override;
    void append_crossings(const MovingPoint& a, const MovingPoint& b,
                          std::vector<Crossing>& crossings) const override;

    bool comes_within(const Vec3& x, double distance) const override;
    bool has_creases() const override { return true; }
    std::optional<Vec3> normal_near(const Vec3& x, double distance) const override;
    /// Returns a hash of the triangles.
    SurfaceIdentity identity() const override { return identity_; }

    /// Returns the distance of a point from the surface, m, or infinity if there are no triangles.
    double distance(const Vec3& x) const;

  private:
    struct Tree;
    std::unique_ptr<Tree> tree_;
    SurfaceIdentity identity_ = no_identity;
};

}  // namespace incise::cutting
