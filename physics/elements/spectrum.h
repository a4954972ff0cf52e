// Eigenvalues and eigenvectors of symmetric matrices, in one compiled function for all sizes.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>

namespace incise::physics {

/// Eigenvalues and eigenvectors of a symmetric matrix.
struct Spectrum {
    Eigen::VectorXd values;   ///< in ascending order
    Eigen::MatrixXd vectors;  ///< orthonormal columns, in the order of `values`
};

/// Returns the spectrum of a symmetric matrix; only its lower triangle is read. The function has no
/// fixed size, since the solver of Eigen takes long to compile for each size.
/// Cost: some 10 n^3 operations.
Spectrum spectrum(const Eigen::Ref<const Eigen::MatrixXd>& symmetric);

}  // namespace incise::physics
