// The blade: a tool that cuts along what its edge sweeps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>
#include <vector>

#include "incise/base/number_format.h"
#include "incise/contact/blade_contact.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"

namespace incise::sim {

namespace {

using cutting::Blade;

std::string fault_of(const Blade& blade) {
    if (const std::string fault = fault_of_line(blade.edge, "edge", "the edge of a blade");
        !fault.empty())
        return fault;
    if (!(blade.toughness >= 0.0 && std::isfinite(blade.toughness)))
        return "its toughness is " + format_number(blade.toughness) + " J/m2: it must be 0 or more";
    if (blade.cutting_force != cutting::CuttingForce::report &&
        blade.cutting_force != cutting::CuttingForce::apply)
        return "there is no such cutting force";
    if (blade.toughness > 0.0 && blade.mode == cutting::CutMode::separate)
        return "its toughness needs the mode split: what it opens is not where its edge is";
    if (blade.cutting_force == cutting::CuttingForce::apply && blade.toughness == 0.0)
        return "its cutting force is applied: it needs a toughness above 0";
    return fault_of_snap(blade.snap);
}

class BladeActor final : public ActorOf<Blade> {
  public:
    explicit BladeActor(const ToolDef& def) : ActorOf(def) { require_none(fault_of(shape())); }

    void require_fit(const Tissue& tissue) const override {
        ActorOf::require_fit(tissue);
        if (tissue.contact)
            require_none(contact::fault_of_toughness(shape(), tissue.model.elements().materials(),
                                                     tissue.contact->size()));
    }

    contact::ToolContact* touch(const Tissue& tissue, double from, double to,
                                double moved) override {
        if (!contact_) contact_.emplace(shape(), tissue.contact->size());
        contact_->move(tissue.model, interpolate(pose(), target(), from),
                       interpolate(pose(), target(), to), [&](const Vec3& x) {
                           return tissue.cutter.tissue_at(tissue.mesh,
                                                          tissue.model.mesh_positions(), x, moved);
                       });
        return &*contact_;
    }
    contact::ToolContact* contact() override { return contact_ ? &*contact_ : nullptr; }
    void end_contact() override { contact_.reset(); }
    bool is_in_tissue(const cutting::Cutter& cutter) const override {
        return cut_ && cutter.is_in_tissue(*cut_);
    }

  private:
    void cut(const Tissue& tissue, const CarryOut& carry_out) override {
        carry_out([&] {
            cutting::place_edge(shape(), pose(), edge_before_);
            cutting::place_edge(shape(), target(), edge_after_);
            motion_.resize(shape().edge.size(), Vec3::Zero());
            if (edge_before_ != edge_after_) find_motion();
            if (shape().mode == cutting::CutMode::separate)
                return tissue.cutter.separate(tissue.mesh, edge_before_, edge_after_);
            return tissue.cutter.split(*cut_, tissue.mesh, edge_before_, edge_after_);
        });
    }
    void leave(const Tissue& tissue, const CarryOut& carry_out) override {
        if (!is_in_tissue(tissue.cutter)) return;
        if (pose_before_end()) {
            cutting::place_edge(shape(), *pose_before_end(), edge_before_);
            find_motion();
        }
        const cutting::BladeEnd blade(edge_after_, motion_);
        carry_out([&] {
            return tissue.cutter.end_cut(*cut_, tissue.mesh, tissue.model.fragments(), blade);
        });
    }
    void find_motion() {
        for (std::size_t i = 0; i < motion_.size(); ++i)
            motion_[i] = edge_after_[i] - edge_before_[i];
    }
    void begin(const Tissue& tissue) override {
        if (shape().mode == cutting::CutMode::split) cut_ = tissue.cutter.begin_cut(shape().snap);
    }
    void save_own(ArchiveWriter& ar) const override {
        ar(cut_, motion_, contact_.has_value());
        if (contact_) contact_->save(ar);
    }
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        ar(cut_, motion_);
        const bool splits = shape().mode == cutting::CutMode::split;
        if (cut_.has_value() != splits || (cut_ && !tissue.cutter.has_cut(*cut_)) ||
            (!motion_.empty() && motion_.size() != shape().edge.size()))
            refuse("has a cut of another one");
        if (!ar.read<bool>()) return;
        if (!tissue.contact) refuse("touches tissue, and there is no contact");
        contact_.emplace(shape(), tissue.contact->size());
        contact_->restore(ar);
    }

    std::optional<cutting::CutId> cut_;  // with the mode split
    // At the edge of the blade before and after a step, and its last motion, m.
    std::vector<Vec3> edge_before_, edge_after_, motion_;
    std::optional<contact::BladeContact> contact_;  // of a blade that feels a force
};

}  // namespace

template <>
struct ActorFor<Blade> {
    using type = BladeActor;
};
template std::unique_ptr<ToolActor> make_actor_of<Blade>(const ToolDef&);

}  // namespace incise::sim
