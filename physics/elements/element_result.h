// What one element does at a given state.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace incise::physics {

/// For output and diagnosis, not for the force loop.
struct ElementResult {
    double energy = 0.0;                                      ///< J
    double volume = 0.0;                                      ///< rest, m3
    double volume_ratio = 1.0;                                ///< J
    Eigen::Matrix3d cauchy_stress = Eigen::Matrix3d::Zero();  ///< Pa

    /// Sets the stress to that which the element's own forces on its corners make: minus their
    /// virial, the sum of f x^T (J), over its volume as it is. Exact for linear elements, and the
    /// mean stress for springs.
    void set_stress(const Eigen::Matrix3d& virial) {
        const double present = volume * volume_ratio;
        if (present == 0.0)  // flat: no volume to spread the stress over
            cauchy_stress.setZero();
        else
            cauchy_stress = -virial / present;
    }
};

}  // namespace incise::physics
