// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/solve/integrator.h"

namespace incise::physics {

void SemiImplicitEuler::step(Model& model, double time, double dt) {
    if (projections_.empty()) {
        model.integrate(time, dt);
        return;
    }
    model.kick(time, dt);
    for (const auto& projection : projections_) projection->project(model, time, dt);
    model.drift(time, dt);
}

}  // namespace incise::physics
