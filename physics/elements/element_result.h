// Energy, volume and stress of one element in a given state.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace incise::physics {

/// The result of one element, for output and diagnosis; the force loop does not use it.
struct ElementResult {
    double energy = 0.0;                                      ///< J
    double volume = 0.0;                                      ///< at rest, m3
    double volume_ratio = 1.0;                                ///< current over rest volume
    Eigen::Matrix3d cauchy_stress = Eigen::Matrix3d::Zero();  ///< Pa

    /// Sets the Cauchy stress from the virial of the forces on the corners, the sum of f x^T, J.
    /// The stress is minus the virial divided by the current volume. It is exact for linear
    /// elements, and the mean stress for springs. It is set to zero for a flat element.
    void set_stress(const Eigen::Matrix3d& virial) {
        const double present = volume * volume_ratio;
        if (present == 0.0)  // the stress of a flat element is undefined
            cauchy_stress.setZero();
        else
            cauchy_stress = -virial / present;
    }
};

}  // namespace incise::physics
