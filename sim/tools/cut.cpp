// The cut: a plane or a surface that divides what it crosses, at once.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>

#include "incise/cutting/surfaces/cut_surface.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"

namespace incise::sim {

namespace {

std::string fault_of(const cutting::PlaneCut& plane) {
    if (!plane.point.allFinite() || !plane.normal.allFinite()) return "its plane is not finite";
    if (!(plane.normal.squaredNorm() > 0.0)) return "the normal of its plane is zero";
    return fault_of_snap(plane.snap);
}

std::string fault_of(const cutting::SurfaceCut& cut) {
    const auto& [points, triangles] = cut.surface;
    if (triangles.empty()) return "its surface has no triangle";
    if (!std::ranges::all_of(points, [](const Vec3& x) { return x.allFinite(); }))
        return "a point of its surface is not finite";
    for (const auto& triangle : triangles)
        for (const std::int64_t p : triangle)
            if (p < 0 || p >= static_cast<std::int64_t>(points.size()))
                return "a triangle of its surface names point " + std::to_string(p) +
                       ", and there are " + std::to_string(points.size());
    return fault_of_snap(cut.snap);
}

/// @tparam Shape  PlaneCut or SurfaceCut
template <class Shape>
class CutActor final : public ActorOf<Shape> {
  public:
    explicit CutActor(const ToolDef& def) : ActorOf<Shape>(def) {
        this->require_none(fault_of(this->shape()));
        surface_ = cutting::cut_surface_of(def.shape);
    }

  private:
    void cut(const Tissue& tissue, const CarryOut& carry_out) override {
        carry_out([&] { return tissue.cutter.split(tissue.mesh, *surface_, this->shape().snap); });
    }

    std::shared_ptr<const cutting::CutSurface> surface_;
};

}  // namespace

template <>
struct ActorFor<cutting::PlaneCut> {
    using type = CutActor<cutting::PlaneCut>;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::PlaneCut>(const ToolDef&);

template <>
struct ActorFor<cutting::SurfaceCut> {
    using type = CutActor<cutting::SurfaceCut>;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::SurfaceCut>(const ToolDef&);

}  // namespace incise::sim
