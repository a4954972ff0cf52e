// The matrices of the HEML paper that give the strain from squared edge lengths. Only comparisons
// use them.
// Source: HEML 2015, (A.1) to (A.6), (C.1).
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include "incise/physics/elements/heml_kernel.h"

namespace incise::bench {

/// The matrices of a tetrahedron with C = sum of l_k C_k over its squared edge lengths l_k.
struct LinkTraces {
    physics::Vec6 vtr;                ///< traces of the C_k: 1/m2
    Eigen::Matrix<double, 6, 6> Mtr;  ///< traces of C_k C_l: 1/m4
};

/// Returns the matrices of a tetrahedron. D = V^T C V is linear in the squared edge lengths,
/// D = sum of l_k D_k, and C_k = V^-T D_k V^-1. Hence tr C_k = tr(D_k G) and
/// tr(C_k C_l) = tr(D_k G D_l G) with G = (V^T V)^-1.
inline LinkTraces link_traces(const physics::LinkElement& element) {
    const physics::Mat3 G = element.inverse_edges * element.inverse_edges.transpose();
    std::array<physics::Mat3, 6> DG;
    const auto link = [&](std::size_t k, int i, int j) {
        physics::Mat3 D = physics::Mat3::Zero();
        if (i == j) {  // from corner 0: row and column i
            D.row(i).setConstant(0.5);
            D.col(i).setConstant(0.5);
            D(i, i) = 1.0;
        } else {  // the off-diagonal entries are (l_i + l_j - l_ij)/2
            D(i, j) = D(j, i) = -0.5;
        }
        DG[k] = D * G;
    };
    link(0, 0, 0);
    link(1, 1, 1);
    link(2, 2, 2);
    link(3, 0, 1);
    link(4, 1, 2);
    link(5, 2, 0);
    LinkTraces traces;
    for (int k = 0; k < 6; ++k) {
        const physics::Mat3& A = DG[static_cast<std::size_t>(k)];
        traces.vtr[k] = A.trace();
        for (int m = 0; m <= k; ++m)
            traces.Mtr(k, m) = traces.Mtr(m, k) =
                A.cwiseProduct(DG[static_cast<std::size_t>(m)].transpose()).sum();
    }
    return traces;
}

}  // namespace incise::bench
