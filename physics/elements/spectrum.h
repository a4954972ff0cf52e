// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace incise::physics {

/// Of a symmetric matrix.
struct Spectrum {
    Eigen::VectorXd values;   ///< ascending
    Eigen::MatrixXd vectors;  ///< columns of length 1, at right angles, in the order of values
};

/// Reads the lower triangle only. One function for all sizes: Eigen's solver takes the compiler
/// longer than any other file, once more for each size that is known to it.
/// Cost: some 10 n^3 operations.
Spectrum spectrum(const Eigen::Ref<const Eigen::MatrixXd>& symmetric);

}  // namespace incise::physics
