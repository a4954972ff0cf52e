// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/spectrum.h"

#include <Eigen/Eigenvalues>

namespace incise::physics {

Spectrum spectrum(const Eigen::Ref<const Eigen::MatrixXd>& symmetric) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(symmetric);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace incise::physics
