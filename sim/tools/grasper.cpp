// The grasper: jaws that hold the surface that is in them when they close.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/base/error.h"
#include "incise/contact/grasp_contact.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"
#include "incise/sim/tools/touching_actor.h"

namespace incise::sim {

namespace {

class GrasperActor final : public TouchingActor<cutting::Grasper, contact::GraspContact> {
  public:
    explicit GrasperActor(const ToolDef& def) : TouchingActor(def) {
        const std::string fault = fault_of_max_force(shape().max_force);
        require_none(fault.empty() ? fault_of_shape(shape().jaws) : fault);
    }

    std::size_t close(const Tissue& tissue) override {
        require_there();
        contact_with(tissue).close(tissue.model, tissue.contact->surface(), pose());
        is_closed_ = true;
        return num_held();
    }
    void open() override {
        require_there();
        if (contact_) contact_->open();
        is_closed_ = false;
    }
    bool is_closed() const override { return is_closed_; }
    std::size_t num_held() const override {
        return is_closed_ && contact_ ? contact_->num_gripped() : 0;
    }

    contact::ToolContact* touch(const Tissue& tissue, double from, double to, double) override {
        contact_with(tissue).move(interpolate(pose(), target(), from),
                                  interpolate(pose(), target(), to));
        return contact();
    }
    void let_go() override {
        TouchingActor::let_go();
        is_closed_ = false;
    }

  private:
    void require_there() const {
        if (!is_present())
            throw InputError("grasper '" + def().name + "' is not there: give it a pose first");
    }
    void leave(const Tissue&, const CarryOut&) override { is_closed_ = false; }
    void save_own(ArchiveWriter& ar) const override {
        ar(is_closed_);
        TouchingActor::save_own(ar);
    }
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        ar(is_closed_);
        restore_contact(ar, tissue, tissue.model);
    }

    bool is_closed_ = false;
};

}  // namespace

template <>
struct ActorFor<cutting::Grasper> {
    using type = GrasperActor;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::Grasper>(const ToolDef&);

}  // namespace incise::sim
