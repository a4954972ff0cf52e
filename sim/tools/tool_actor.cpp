// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tools/tool_actor.h"

#include <utility>

#include "incise/base/error.h"

namespace incise::sim {

void ToolActor::require_none(const std::string& fault) const {
    if (!fault.empty()) throw InputError("tool '" + def_.name + "': " + fault);
}

void ToolActor::refuse(const std::string& why) const {
    throw InputError("tool '" + def_.name + "' " + why);
}

void ToolActor::require_fit(const Tissue& tissue, const physics::MaterialTable&) const {
    if (cutting::feels_force(def_.shape) && !tissue.contact)
        refuse("exerts a force: it needs the explicit solver, with contact enabled");
}

void ToolActor::require_sound(const Pose& pose) const {
    if (!pose.is_sound())
        require_none("its pose must have a finite position, m, and a rotation of length 1");
}

void ToolActor::require_pose(const Pose& pose) const {
    require_sound(pose);
    if (!cutting::traits_of(def_.shape).has_pose)
        refuse("is a suture, which has no pose: use tie_suture()");
}

void ToolActor::place(const Tissue& tissue, const Pose& pose) {
    require_pose(pose);
    if (is_in_tissue(tissue.cutter))
        refuse("is in the tissue: withdraw it before it is put elsewhere");
    let_go();
    set_present(true);
    pose_ = target_ = pose;
}

void ToolActor::require_possible(const ToolInput& input) const {
    if (input.pose) require_pose(*input.pose);
    if (input.length) refuse("is no suture");
    if (input.is_withdrawn && !is_present_ && !input.pose) refuse("is not there to be withdrawn");
    if (input.pose_before_end) require_sound(*input.pose_before_end);
}

void ToolActor::take(const ToolInput& input) {
    if (input.pose) {
        if (!is_present_) pose_ = *input.pose;
        is_present_ = true;
        target_ = *input.pose;
    }
    is_leaving_ = input.is_withdrawn;
    pose_before_end_ = input.pose_before_end;
}

std::size_t ToolActor::close(const Tissue&) { refuse("has no jaws that close"); }
void ToolActor::open() { refuse("has no jaws that open"); }
std::size_t ToolActor::tie(const Tissue&) { refuse("is no suture"); }
double ToolActor::length() const { refuse("is no suture"); }
void ToolActor::untie() { refuse("is no suture"); }
bool ToolActor::is_tied() const { refuse("is no suture"); }

contact::ToolContact* ToolActor::touch(const Tissue&, double, double, double) { return nullptr; }

void ToolActor::act(const Tissue& tissue, const CarryOut& carry_out) {
    if (!is_present_) return;
    cut(tissue, carry_out);
    pose_ = target_;
    arrive();
    if (!is_leaving_) return;
    leave(tissue, carry_out);
    has_just_left_ = cutting::feels_force(def_.shape);
    set_present(false);
}

void ToolActor::save(ArchiveWriter& ar) const {
    ar(def_.name, def_.shape);
    list(ar, *this);
    save_own(ar);
}

namespace {

std::unique_ptr<ToolActor> sound_actor(const ToolDef& def, const Tissue& tissue) {
    auto actor =
        std::visit([&]<class Shape>(const Shape&) { return make_actor_of<Shape>(def); }, def.shape);
    actor->require_fit(tissue, tissue.model.structure().elements().materials());
    return actor;
}

}  // namespace

std::unique_ptr<ToolActor> make_actor(const ToolDef& def, const Tissue& tissue) {
    auto actor = sound_actor(def, tissue);
    actor->begin(tissue);
    return actor;
}

std::unique_ptr<ToolActor> load_actor(ArchiveReader& ar, const Tissue& tissue) {
    ToolDef def;
    ar(def.name, def.shape);
    std::unique_ptr<ToolActor> actor = sound_actor(def, tissue);
    ToolActor::list(ar, *actor);
    actor->require_sound(actor->pose_);
    actor->target_ = actor->pose_;
    actor->restore_own(ar, tissue);
    return actor;
}

}  // namespace incise::sim
