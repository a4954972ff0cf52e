// The suture: a thread through points of the tissue, which it draws together.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "incise/base/error.h"
#include "incise/base/number_format.h"
#include "incise/contact/suture_contact.h"
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"
#include "incise/sim/tools/touching_actor.h"

namespace incise::sim {

namespace {

std::string fault_of(const cutting::Suture& suture) {
    if (std::string fault = fault_of_line(suture.points, "thread", "a suture"); !fault.empty())
        return fault;
    if (!(suture.stiffness > 0.0 && std::isfinite(suture.stiffness)))
        return "its stiffness is " + format_number(suture.stiffness) + " N/m: it must be above 0";
    if (std::string fault = fault_of_max_force(suture.max_force); !fault.empty()) return fault;
    if (!(suture.reach >= 0.0 && std::isfinite(suture.reach)))
        return "its reach is " + format_number(suture.reach) + " m: it must be 0 or more";
    return "";
}

/// Without contact it is never made.
class SutureActor final : public TouchingActor<cutting::Suture, contact::SutureContact> {
  public:
    explicit SutureActor(const ToolDef& def) : TouchingActor(def) {
        require_none(fault_of(shape()));
    }

    std::size_t tie(const Tissue& tissue) override {
        contact_with(tissue).tie(tissue.model);
        set_present(true);
        length_ = target_length_ = contact_->length();
        return num_points();
    }
    void require_possible(const ToolInput& input) const override {
        if (input.length) {
            if (!is_present()) throw InputError("suture '" + def().name + "' is not tied");
            if (!(*input.length >= 0.0 && std::isfinite(*input.length)))
                throw InputError("suture '" + def().name + "': a length of " +
                                 format_number(*input.length) + " m: it must be 0 or more");
        }
        ToolInput rest = input;
        rest.length.reset();
        TouchingActor::require_possible(rest);
    }
    void take(const ToolInput& input) override {
        TouchingActor::take(input);
        if (input.length) target_length_ = *input.length;
    }
    double length() const override { return is_present() ? length_ : 0.0; }
    void untie() override {
        let_go();
        set_present(false);
    }
    bool is_tied() const override { return is_present() && num_points() >= 2; }

    contact::ToolContact* touch(const Tissue&, double, double to, double) override {
        if (contact_) contact_->draw(std::lerp(length_, target_length_, to));
        return contact();
    }

  private:
    std::size_t num_points() const { return contact_ ? contact_->num_gripped() : 0; }
    void arrive() override { length_ = target_length_; }
    void save_own(ArchiveWriter& ar) const override {
        ar(length_);
        TouchingActor::save_own(ar);
    }
    void restore_own(ArchiveReader& ar, const Tissue& tissue) override {
        ar(length_);
        if (!(length_ >= 0.0 && std::isfinite(length_))) require_none("its thread has no length");
        target_length_ = length_;
        restore_contact(ar, tissue, tissue.model);
    }

    double length_ = 0.0, target_length_ = 0.0;  // now and at the end of the step, m
};

}  // namespace

template <>
struct ActorFor<cutting::Suture> {
    using type = SutureActor;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::Suture>(const ToolDef&);

}  // namespace incise::sim
