// The energy of a body in explicit steps at one moment.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <cstddef>

#include "incise/physics/body/model.h"

namespace incise::test {

/// Returns the sum of elastic and kinetic energy, J, with the velocities of the present: those of
/// the model are half a step older.
/// @param dt  the last step, s
/// @pre  the forces of the state are computed
inline double present_energy(const physics::Model& model, double dt) {
    double energy = model.energetics().totals().elastic_energy;
    for (std::size_t n = 0; n < model.masses().size(); ++n) {
        const double mass = model.masses()[n];
        if (mass == 0.0) continue;
        const Vec3 v = model.velocities()[n] + 0.5 * dt / mass * model.elastic_forces()[n];
        energy += 0.5 * mass * v.squaredNorm();
    }
    return energy;
}

}  // namespace incise::test
