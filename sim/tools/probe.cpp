// The probe: a rigid tool that pushes tissue. Obstacles are probes that stand still.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "incise/base/number_format.h"
#include "incise/contact/rigid_contact.h"
#include "incise/cutting/tools/probe_shape.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"
#include "incise/sim/tools/touching_actor.h"

namespace incise::sim {

namespace {

std::string fault_of(const cutting::Probe& probe) {
    if (!(probe.friction >= 0.0 && std::isfinite(probe.friction)))
        return "its friction is " + format_number(probe.friction) + ": it must be 0 or more";
    return fault_of_shape(probe.shape);
}

class ProbeActor final : public TouchingActor<cutting::Probe, contact::RigidContact> {
  public:
    explicit ProbeActor(const ToolDef& def) : TouchingActor(def) {
        require_none(fault_of(shape()));
        half_width_ = cutting::half_width_of(shape().shape);
        reach_ = cutting::reach_of(shape().shape);
    }

    // So that the probe does not pass through a surface.
    double num_substeps(const Pose& to, double element_size) const override {
        constexpr double most = 0.25;  // of an element, or of the probe
        const double move = (to.position - pose().position).norm() +
                            reach_ * pose().rotation.angularDistance(to.rotation);
        return std::ceil(move / (most * std::min(half_width_, element_size)));
    }
    contact::ToolContact* touch(const Tissue& tissue, double from, double to, double) override {
        contact_with(tissue).move(interpolate(pose(), target(), from),
                                  interpolate(pose(), target(), to));
        return contact();
    }

  private:
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        restore_contact(ar, tissue, tissue.contact->surface());
    }

    double half_width_ = 0.0, reach_ = 0.0;  // m: see probe_shape.h
};

}  // namespace

template <>
struct ActorFor<cutting::Probe> {
    using type = ProbeActor;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::Probe>(const ToolDef&);

}  // namespace incise::sim
