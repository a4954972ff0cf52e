// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/heml_kernel.h"

#include <Eigen/LU>

#include "topology/geometry.h"

namespace incise::physics {

Vec6 squared_links(const std::array<Vec3, 4>& x) {
    Vec6 l;
    l << (x[1] - x[0]).squaredNorm(), (x[2] - x[0]).squaredNorm(), (x[3] - x[0]).squaredNorm(),
        (x[2] - x[1]).squaredNorm(), (x[3] - x[2]).squaredNorm(), (x[1] - x[3]).squaredNorm();
    return l;
}

Mat3 edge_matrix(const std::array<Vec3, 4>& x) {
    Mat3 v;
    v << x[1] - x[0], x[2] - x[0], x[3] - x[0];
    return v;
}

LinkElement link_element(const std::array<Vec3, 4>& X) {
    LinkElement element;
    element.volume = topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
    element.rest_links = squared_links(X);
    const Mat3 V = edge_matrix(X);
    const Mat3 G = (V.transpose() * V).inverse();
    // D = V^T C V is linear in the links, D = sum of l_k D_k, and C_k = V^-T D_k V^-1: hence
    // tr C_k = tr(D_k G) and tr(C_k C_l) = tr(D_k G D_l G).
    std::array<Mat3, 6> DG;
    const auto link = [&](std::size_t k, int i, int j) {
        Mat3 D = Mat3::Zero();
        if (i == j) {  // from corner 0: row and column i
            D.row(i).setConstant(0.5);
            D.col(i).setConstant(0.5);
            D(i, i) = 1.0;
        } else {
            D(i, j) = D(j, i) = -0.5;
        }
        DG[k] = D * G;
    };
    // The off-diagonal entries are (l_i + l_j - l_ij)/2.
    link(0, 0, 0);
    link(1, 1, 1);
    link(2, 2, 2);
    link(3, 0, 1);
    link(4, 1, 2);
    link(5, 2, 0);
    for (int k = 0; k < 6; ++k) {
        const Mat3& A = DG[static_cast<std::size_t>(k)];
        element.vtr[k] = A.trace();
        for (int m = 0; m <= k; ++m)
            element.Mtr(k, m) = element.Mtr(m, k) =
                A.cwiseProduct(DG[static_cast<std::size_t>(m)].transpose()).sum();
    }
    return element;
}

LinkElement HemlKernel::precompute(const Corners& X, const Vec3& fibre) const {
    LinkElement element = link_element(X);
    if (has_fibres(law)) {
        element.fibre = fibre;
        // With u = V^-1 a0, a0 . C_k a0 = u . D_k u.
        const Vec3 u = edge_matrix(X).inverse() * fibre;
        element.fibre_components = u;
        element.fibre_links << u.sum() * u, -u[0] * u[1], -u[1] * u[2], -u[2] * u[0];
    }
    return element;
}

double HemlKernel::volume_ratio(const Element& e, const Corners& x) const {
    return topology::tetrahedron_volume(x[0], x[1], x[2], x[3]) / e.volume;
}

double HemlKernel::stiffness_energy(const Element& e) const {
    const RestFibres fibres = rest_fibres(law);
    const double along = 1.0 - 2.0 * fibres.dispersion;  // a0 . H a0
    return (rest_lambda(law) + 2.0 * rest_mu(law) + fibres.modulus * along * along) * e.volume;
}

double HemlKernel::energy(const Element& e, const Corners& x) const {
    const Vec6 dl = squared_links(x) - e.rest_links;
    return e.volume * response(law, strain(e, dl, e.Mtr * dl, x), inversion_threshold).w;
}

std::array<Vec3, 4> HemlKernel::forces(const Element& e, const Corners& x) const {
    const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
    const Vec6 dl = squared_links(x) - e.rest_links;
    const Vec6 Mdl = e.Mtr * dl;
    const LawResponse r = response(law, strain(e, dl, Mdl, x), inversion_threshold);
    // Tension of the links, Vol dw/dl, doubled as the DLM_i have it.
    const Vec6 t = 2.0 * e.volume * (r.w_a * e.vtr + 2.0 * r.w_b * Mdl + r.w_f * e.fibre_links);
    const double p = r.w_J / 6.0;  // w_J dvol/dx_i, eq. (C.4)
    const Vec3 f1 = -((t[0] + t[3] + t[5]) * v1 - t[3] * v2 - t[5] * v3 + p * v2.cross(v3));
    const Vec3 f2 = -((t[1] + t[3] + t[4]) * v2 - t[3] * v1 - t[4] * v3 + p * v3.cross(v1));
    const Vec3 f3 = -((t[2] + t[4] + t[5]) * v3 - t[4] * v2 - t[5] * v1 + p * v1.cross(v2));
    return {-(f1 + f2 + f3), f1, f2, f3};
}

std::array<double, 4> HemlKernel::stiffness_bounds(const Element& e, const Corners& X) const {
    const RestFibres fibres = rest_fibres(law);
    const double kappa = fibres.dispersion;
    std::array<double, 4> inverse_altitude, fibre_part;  // fibre_part: |H g_i|
    double sum = 0.0, fibre_sum = 0.0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 &a = X[(i + 1) % 4], &b = X[(i + 2) % 4], &c = X[(i + 3) % 4];
        const Vec3 gradient = (b - a).cross(c - a) / (6.0 * e.volume);
        inverse_altitude[i] = gradient.norm();
        sum += inverse_altitude[i];
        fibre_part[i] =
            (kappa * gradient + (1.0 - 3.0 * kappa) * e.fibre.dot(gradient) * e.fibre).norm();
        fibre_sum += fibre_part[i];
    }
    const double modulus = (rest_lambda(law) + 2.0 * rest_mu(law)) * e.volume;
    std::array<double, 4> s;
    for (std::size_t i = 0; i < 4; ++i)
        s[i] = modulus * inverse_altitude[i] * sum +
               fibres.modulus * e.volume * fibre_part[i] * fibre_sum;
    return s;
}

LinkStrain<double> HemlKernel::strain(const Element& e, const Vec6& dl, const Vec6& Mdl,
                                      const Corners& x) const {
    return {e.vtr.dot(dl), dl.dot(Mdl), volume_ratio(e, x), e.fibre_links.dot(dl)};
}

}  // namespace incise::physics
