// Hyper-elastic mass links: the forces of one tetrahedron from its six squared edge lengths.
// Readable double-precision reference.
// Source: HEML 2015, section 3 and appendices A-C; corrections in docs/theory.md.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <type_traits>

#include "physics/law.h"
#include "topology/geometry.h"
#include "topology/types.h"

namespace incise::physics {

using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat3 = Eigen::Matrix3d;

/// Squared edge lengths in the order of the paper: 01, 02, 03, 12, 23, 31.
inline Vec6 squared_links(const std::array<Vec3, 4>& x) {
    Vec6 l;
    l << (x[1] - x[0]).squaredNorm(), (x[2] - x[0]).squaredNorm(), (x[3] - x[0]).squaredNorm(),
        (x[2] - x[1]).squaredNorm(), (x[3] - x[2]).squaredNorm(), (x[1] - x[3]).squaredNorm();
    return l;
}

/// What a tetrahedron keeps of its rest shape.
struct LinkElement {
    double volume;    ///< m3
    Vec6 rest_links;  ///< m2
    Vec6 vtr;         ///< traces of the C_k, where C = sum of l_k C_k: 1/m2
    Mat6 Mtr;         ///< traces of C_k C_l: 1/m4
};

/// Eqs. (A.1) to (A.6) and (C.1). Pure in the four rest positions.
inline LinkElement link_element(const std::array<Vec3, 4>& X) {
    LinkElement element;
    element.volume = topology::tetrahedron_volume(X[0], X[1], X[2], X[3]);
    element.rest_links = squared_links(X);
    Mat3 V;
    V << X[1] - X[0], X[2] - X[0], X[3] - X[0];
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

/// Of a law with fibres.
struct FibredLinkElement : LinkElement {
    Vec3 fibre;        ///< a0: their direction at rest, of unit length
    Vec6 fibre_links;  ///< a0 . C_k a0, so that I4 = sum of l_k a0 . C_k a0: 1/m2
};

/// Pure in the rest positions and the direction. With u = V^-1 a0, a0 . C_k a0 = u . D_k u.
inline FibredLinkElement fibred_link_element(const std::array<Vec3, 4>& X, const Vec3& fibre) {
    FibredLinkElement element{link_element(X), fibre, {}};
    Mat3 V;
    V << X[1] - X[0], X[2] - X[0], X[3] - X[0];
    const Vec3 u = V.inverse() * fibre;
    element.fibre_links << u.sum() * u, -u[0] * u[1], -u[1] * u[2], -u[2] * u[0];
    return element;
}

/// HEML with a given law, for blocks of tetrahedra (element_block.h).
template <class LawType>
struct HemlKernel {
    static constexpr std::size_t num_corners = 4;
    static constexpr bool has_fibres = HasFibres<LawType>;
    using Corners = std::array<Vec3, 4>;
    using Element = std::conditional_t<has_fibres, FibredLinkElement, LinkElement>;

    LawType law;
    double inversion_threshold;

    Element precompute(const Corners& X) const requires(!has_fibres) { return link_element(X); }
    /// @param fibre  their direction at rest, of unit length
    Element precompute(const Corners& X, const Vec3& fibre) const requires has_fibres {
        return fibred_link_element(X, fibre);
    }

    double volume_ratio(const Element& e, const Corners& x) const {
        return topology::tetrahedron_volume(x[0], x[1], x[2], x[3]) / e.volume;
    }

    /// Highest P-wave modulus at rest times rest volume, joules.
    double stiffness_energy(const Element& e) const {
        double modulus = law.rest_lambda() + 2.0 * law.rest_mu();
        if constexpr (has_fibres) {
            const double along = 1.0 - 2.0 * law.dispersion;  // a0 . H a0
            modulus += law.rest_fibre_modulus() * along * along;
        }
        return modulus * e.volume;
    }

    /// Elastic energy, joules.
    double energy(const Element& e, const Corners& x) const {
        const Vec6 dl = squared_links(x) - e.rest_links;
        return e.volume * law.response(strain(e, dl, e.Mtr * dl, x), inversion_threshold).w;
    }

    /// Nodal forces: minus the gradient of energy(), eq. (11):
    /// f_i = -[ Vol (w_l^T DLM_i) v^T + w_J dvol/dx_i ].
    Corners forces(const Element& e, const Corners& x) const {
        const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
        const Vec6 dl = squared_links(x) - e.rest_links;
        const Vec6 Mdl = e.Mtr * dl;
        const LawResponse r = law.response(strain(e, dl, Mdl, x), inversion_threshold);
        // Tension of the links, Vol dw/dl, doubled as the DLM_i have it.
        Vec6 t = 2.0 * e.volume * (r.w_a * e.vtr + 2.0 * r.w_b * Mdl);
        if constexpr (has_fibres) t += 2.0 * e.volume * r.w_f * e.fibre_links;
        const double p = r.w_J / 6.0;  // w_J dvol/dx_i, eq. (C.4)
        const Vec3 f1 = -((t[0] + t[3] + t[5]) * v1 - t[3] * v2 - t[5] * v3 + p * v2.cross(v3));
        const Vec3 f2 = -((t[1] + t[3] + t[4]) * v2 - t[3] * v1 - t[4] * v3 + p * v3.cross(v1));
        const Vec3 f3 = -((t[2] + t[4] + t[5]) * v3 - t[4] * v2 - t[5] * v1 + p * v1.cross(v2));
        return {-(f1 + f2 + f3), f1, f2, f3};
    }

    /// Each corner's part s_i = (lambda + 2 mu) V (1/h_i) sum_j 1/h_j of the nodal bound on the
    /// stiffness at rest (stable_step.h), N/m; h are the altitudes. Fibres that are stretched add
    /// c V |H g_i| sum_j |H g_j|, for c and H see HasFibres, g_i the gradient of corner i's shape
    /// function, of length 1/h_i.
    std::array<double, 4> stiffness_bounds(const Element& e, const Corners& X) const {
        std::array<double, 4> inverse_altitude;
        [[maybe_unused]] std::array<double, 4> fibre_part;  // |H g_i|
        double sum = 0.0;
        [[maybe_unused]] double fibre_sum = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
            const Vec3 &a = X[(i + 1) % 4], &b = X[(i + 2) % 4], &c = X[(i + 3) % 4];
            inverse_altitude[i] = (b - a).cross(c - a).norm() / (6.0 * e.volume);
            sum += inverse_altitude[i];
            if constexpr (has_fibres) {
                const Vec3 gradient = (b - a).cross(c - a) / (6.0 * e.volume);
                const double kappa = law.dispersion;
                fibre_part[i] =
                    (kappa * gradient + (1.0 - 3.0 * kappa) * e.fibre.dot(gradient) * e.fibre)
                        .norm();
                fibre_sum += fibre_part[i];
            }
        }
        const double modulus = (law.rest_lambda() + 2.0 * law.rest_mu()) * e.volume;
        std::array<double, 4> s;
        for (std::size_t i = 0; i < 4; ++i) s[i] = modulus * inverse_altitude[i] * sum;
        if constexpr (has_fibres)
            for (std::size_t i = 0; i < 4; ++i)
                s[i] += law.rest_fibre_modulus() * e.volume * fibre_part[i] * fibre_sum;
        return s;
    }

    /// @param Mdl  Mtr times dl, the changes of the squared links
    LinkStrain<double> strain(const Element& e, const Vec6& dl, const Vec6& Mdl,
                              const Corners& x) const {
        LinkStrain<double> s{e.vtr.dot(dl), dl.dot(Mdl), volume_ratio(e, x)};
        if constexpr (has_fibres) s.f = e.fibre_links.dot(dl);
        return s;
    }
};

}  // namespace incise::physics
