// The carver: a tool that removes the cells whose centre its shape covers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/sim/tools/kinds.h"
#include "incise/sim/tools/shape_faults.h"

namespace incise::sim {

namespace {

class CarverActor final : public ActorOf<cutting::Carver> {
  public:
    explicit CarverActor(const ToolDef& def) : ActorOf(def) {
        require_none(fault_of_shape(shape().shape));
    }

  private:
    void cut(const Tissue& tissue, const CarryOut& carry_out) override {
        carry_out(
            [&] { return tissue.cutter.carve(tissue.mesh, shape().shape, pose(), target()); });
    }
};

}  // namespace

template <>
struct ActorFor<cutting::Carver> {
    using type = CarverActor;
};
template std::unique_ptr<ToolActor> make_actor_of<cutting::Carver>(const ToolDef&);

}  // namespace incise::sim
