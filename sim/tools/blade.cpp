// The blade: a tool that cuts along what its edge sweeps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "incise/base/number_format.h"
#include "incise/contact/blade_contact.h"
#include "incise/sim/tools/edge_cut.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"
#include "incise/sim/tools/touching_actor.h"

namespace incise::sim {

namespace {

using cutting::Blade;

std::string fault_of(const Blade& blade) {
    if (std::string fault = fault_of_line(blade.edge, "edge", "the edge of a blade");
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

class BladeActor final : public TouchingActor<Blade, contact::BladeContact> {
  public:
    explicit BladeActor(const ToolDef& def) : TouchingActor(def) {
        require_none(fault_of(shape()));
    }

    void require_fit(const Tissue& tissue, const physics::MaterialTable& materials) const override {
        TouchingActor::require_fit(tissue, materials);
        if (tissue.contact)
            require_none(contact::fault_of_toughness(shape(), materials, tissue.contact->size()));
    }

    contact::ToolContact* touch(const Tissue& tissue, double from, double to,
                                double moved) override {
        contact_with(tissue).move(tissue.model, interpolate(pose(), target(), from),
                                  interpolate(pose(), target(), to), [&](const Vec3& x) {
                                      return tissue.cutter.tissue_at(
                                          tissue.mesh, tissue.model.mesh_positions(), x, moved);
                                  });
        return contact();
    }
    bool is_in_tissue(const cutting::Cutter& cutter) const override {
        return edge_.is_in_tissue(cutter);
    }

  private:
    void cut(const Tissue& tissue, const CarryOut& carry_out) override {
        carry_out([&] {
            cutting::place_edge(shape(), pose(), edge_.before);
            cutting::place_edge(shape(), target(), edge_.after);
            if (shape().mode == cutting::CutMode::separate)
                return tissue.cutter.separate(tissue.mesh, edge_.before, edge_.after);
            return edge_.split(tissue);
        });
    }
    void leave(const Tissue& tissue, const CarryOut& carry_out) override {
        if (!is_in_tissue(tissue.cutter)) return;
        if (pose_before_end()) {
            cutting::place_edge(shape(), *pose_before_end(), edge_.before);
            edge_.find_motion();
        }
        carry_out([&] { return edge_.end(tissue); });
    }
    bool splits() const { return shape().mode == cutting::CutMode::split; }
    void begin(const Tissue& tissue) override {
        if (splits()) edge_.begin(tissue.cutter, shape().snap);
    }
    void save_own(ArchiveWriter& ar) const override {
        edge_.save(ar);
        TouchingActor::save_own(ar);
    }
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        if (!edge_.restore(ar, tissue.cutter, splits(), shape().edge.size()))
            refuse("has a cut of another one");
        restore_contact(ar, tissue);
    }

    EdgeCut edge_;
};

}  // namespace

template <>
struct ActorFor<Blade> {
    using type = BladeActor;
};
template std::unique_ptr<ToolActor> make_actor_of<Blade>(const ToolDef&);

}  // namespace incise::sim
