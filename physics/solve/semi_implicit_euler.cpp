// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cmath>

#include "incise/base/archive.h"
#include "incise/base/error.h"
#include "incise/physics/solve/integrator.h"

namespace incise::physics {

void SemiImplicitEuler::step(Model& model, double time, double dt) {
    // Steps that divide an interval equally differ by rounding.
    constexpr double rounding = 1e-8;
    if (dt_ == 0.0) dt_ = dt;
    if (std::abs(dt - dt_) > rounding * dt) {
        shift_velocities(model, 0.5 * (dt_ - dt));
        dt_ = dt;
    }
    acting_.clear();
    for (VelocityProjection* const projection : projections_)
        if (projection->prepare(model, time, dt)) acting_.push_back(projection);
    if (acting_.empty()) {
        step_.move(model, time, dt);
        return;
    }
    step_.kick(model, time, dt);
    for (VelocityProjection* const projection : acting_)
        projection->project(model, step_, time, dt);
    step_.drift(model, time, dt);
}

void SemiImplicitEuler::save(ArchiveWriter& ar) const { ar(dt_); }

void SemiImplicitEuler::restore(ArchiveReader& ar, const Model&) {
    ar(dt_);
    if (!(dt_ >= 0.0 && std::isfinite(dt_))) throw InputError("its last step is not 0 or more");
}

}  // namespace incise::physics
