// SPDX-License-Identifier: LGPL-3.0-or-later
#include "physics/element_tangent.h"

#include "physics/spectrum.h"

namespace incise::physics {

namespace {

/// v -> u x v.
Mat3 cross_matrix(const Vec3& u) {
    Mat3 m;
    m << 0.0, -u[2], u[1], u[2], 0.0, -u[0], -u[1], u[0], 0.0;
    return m;
}

/// A S A^T. By loops, since products of Eigen of these sizes take the compiler long.
template <int m, int n>
Eigen::Matrix<double, m, m> congruent(const Eigen::Matrix<double, m, n>& A,
                                      const Eigen::Matrix<double, n, n>& S) {
    Eigen::Matrix<double, m, n> AS = Eigen::Matrix<double, m, n>::Zero();
    for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < m; ++i) AS(i, j) += A(i, k) * S(k, j);
    Eigen::Matrix<double, m, m> result = Eigen::Matrix<double, m, m>::Zero();
    for (int j = 0; j < m; ++j)
        for (int k = 0; k < n; ++k)
            for (int i = 0; i < m; ++i) result(i, j) += AS(i, k) * A(j, k);
    return result;
}

/// Of a tetrahedron, from the derivatives by its corners 1 to 3: a shift of all four changes
/// nothing.
ElementTangent<4> with_first_corner(const Eigen::Matrix<double, 9, 9>& inner) {
    ElementTangent<4> K;
    K.bottomRightCorner<9, 9>() = inner;
    for (int j = 3; j < 12; j += 3)
        K.block<3, 3>(0, j) = -(K.block<3, 3>(3, j) + K.block<3, 3>(6, j) + K.block<3, 3>(9, j));
    K.bottomLeftCorner<9, 3>() = K.topRightCorner<3, 9>().transpose();
    K.topLeftCorner<3, 3>() = -(K.block<3, 3>(0, 3) + K.block<3, 3>(0, 6) + K.block<3, 3>(0, 9));
    return K;
}

/// Adds s_ij times the identity at corners i and j, from 1 on.
void add_scalars(const Mat3& s, Eigen::Matrix<double, 9, 9>& inner) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) inner.block<3, 3>(3 * i, 3 * j).diagonal().array() += s(i, j);
}

/// Adds a spring between the corners i and j; one without length has no tangent.
template <std::size_t n>
void add_spring(std::size_t i, std::size_t j, double stiffness, double rest_length,
                const std::array<Vec3, n>& x, ElementTangent<n>& K) {
    const Vec3 v = x[j] - x[i];
    const double length = v.norm();
    if (length == 0.0 || stiffness == 0.0) return;
    const double slack = rest_length / length;
    Mat3 k = (stiffness * slack / (length * length)) * (v * v.transpose());
    k.diagonal().array() += stiffness * (1.0 - slack);
    const auto a = static_cast<Eigen::Index>(3 * i), b = static_cast<Eigen::Index>(3 * j);
    K.template block<3, 3>(a, a) += k;
    K.template block<3, 3>(b, b) += k;
    K.template block<3, 3>(a, b) -= k;
    K.template block<3, 3>(b, a) -= k;
}

template <int n>
Eigen::Matrix<double, n, n> without_negative_modes(const Eigen::Matrix<double, n, n>& K) {
    const Spectrum modes = spectrum(K);
    Eigen::Matrix<double, n, n> positive = Eigen::Matrix<double, n, n>::Zero();
    for (int k = 0; k < n; ++k) {
        const double value = modes.values[k];
        const auto mode = modes.vectors.col(k);
        if (value > 0.0)
            for (int j = 0; j < n; ++j) positive.col(j) += value * mode[j] * mode;
    }
    return positive;
}

}  // namespace

// With the invariants p of strain: Vol (sum of w_pq grad p grad q^T + sum of w_p grad grad p).
ElementTangent<4> element_tangent(const HemlKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x) {
    const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
    const Vec6 dl = squared_links(x) - e.rest_links;
    const Vec6 Mdl = e.Mtr * dl;
    const LawResponse<Dual> r = response(kernel.law, with_derivatives(kernel.strain(e, dl, Mdl, x)),
                                         kernel.inversion_threshold);

    // Gradients of the squared links by corners 1 to 3.
    Eigen::Matrix<double, 9, 6> L = Eigen::Matrix<double, 9, 6>::Zero();
    const auto from_first = [&](int link, int i, const Vec3& v) {
        L.block<3, 1>(3 * i, link) = 2.0 * v;
    };
    const auto between = [&](int link, int i, int j, const Vec3& v) {
        L.block<3, 1>(3 * i, link) = -2.0 * v;
        L.block<3, 1>(3 * j, link) = 2.0 * v;
    };
    from_first(0, 0, v1);
    from_first(1, 1, v2);
    from_first(2, 2, v3);
    between(3, 0, 1, v2 - v1);
    between(4, 1, 2, v3 - v2);
    between(5, 2, 0, v1 - v3);

    Eigen::Matrix<double, 9, 4> gradients;  // of a, b, J and f
    gradients.col(0) = L * e.vtr;
    gradients.col(1) = 2.0 * (L * Mdl);
    gradients.col(2) << v2.cross(v3), v3.cross(v1), v1.cross(v2);
    gradients.col(2) /= 6.0 * e.volume;
    gradients.col(3) = L * e.fibre_links;
    Eigen::Matrix4d w;
    w.col(0) = r.w_a.gradient;
    w.col(1) = r.w_b.gradient;
    w.col(2) = r.w_J.gradient;
    w.col(3) = r.w_f.gradient;
    w = (0.5 * (w + w.transpose())).eval();

    Eigen::Matrix<double, 9, 9> inner = congruent(gradients, w);
    inner += 2.0 * r.w_b.value * congruent(L, e.Mtr);
    const Vec6 t =
        2.0 * (r.w_a.value * e.vtr + 2.0 * r.w_b.value * Mdl + r.w_f.value * e.fibre_links);
    Mat3 tension;
    tension << t[0] + t[3] + t[5], -t[3], -t[5],  //
        -t[3], t[1] + t[3] + t[4], -t[4],         //
        -t[5], -t[4], t[2] + t[4] + t[5];
    add_scalars(tension, inner);
    const auto couple = [&](int i, int j, const Mat3& K) {
        inner.block<3, 3>(3 * i, 3 * j) += K;
        inner.block<3, 3>(3 * j, 3 * i) += K.transpose();
    };
    const double p = r.w_J.value / (6.0 * e.volume);
    couple(0, 1, -p * cross_matrix(v3));
    couple(0, 2, p * cross_matrix(v2));
    couple(1, 2, -p * cross_matrix(v1));
    return with_first_corner(e.volume * inner);
}

ElementTangent<4> tangent_of_stress(const Mat3& S, double volume, const Mat3& inverse_edges) {
    Eigen::Matrix<double, 9, 9> inner = Eigen::Matrix<double, 9, 9>::Zero();
    add_scalars(volume * (inverse_edges * S * inverse_edges.transpose()), inner);
    return with_first_corner(inner);
}

ElementTangent<4> element_tangent(const ViscousKernel& kernel, const ViscousKernel::Element& e,
                                  const std::array<Vec3, 4>& x,
                                  const ViscousKernel::EndOfStep& end) {
    const HemlKernel& elastic = kernel;
    const LinkElement& element = e;
    return end.share * element_tangent(elastic, element, x) +
           tangent_of_stress(end.stress, e.volume, e.inverse_edges);
}

// The constant stress of the nodal rule does not depend on the positions.
ElementTangent<4> element_tangent(const NodalViscousKernel& kernel,
                                  const NodalViscousKernel::Element& e,
                                  const std::array<Vec3, 4>& x,
                                  const NodalViscousKernel::EndOfStep& end) {
    const HemlKernel& elastic = kernel;
    const LinkElement& element = e;
    return end.share * element_tangent(elastic, element, x);
}

ElementTangent<4> element_tangent(const MassSpringKernel&, const MassSpringKernel::Element& e,
                                  const std::array<Vec3, 4>& x) {
    ElementTangent<4> K = ElementTangent<4>::Zero();
    for (std::size_t k = 0; k < e.stiffnesses.size(); ++k) {
        const auto [i, j] = MassSpringKernel::edges[k];
        add_spring(i, j, e.stiffnesses[k], e.rest_lengths[k], x, K);
    }
    return K;
}

/// Of the volume term: kappa/V (grad V' grad V'^T + (V' - V) grad grad V').
ElementTangent<8> element_tangent(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                                  const std::array<Vec3, 8>& x) {
    ElementTangent<8> K = ElementTangent<8>::Zero();
    for (std::size_t g = 0; g < HybmssKernel::springs.size(); ++g)
        for (const auto& [i, j] : HybmssKernel::springs[g])
            add_spring(i, j, e.springs.stiffnesses[g], e.springs.lengths[g], x, K);
    const double kappa = kernel.material.volume_modulus;
    if (kappa == 0.0) return K;
    // By the edges a, b and c of the frame, of which each corner moves a quarter.
    const BoxFrame now(x);
    Eigen::Matrix<double, 9, 1> gradient;
    gradient << now.b.cross(now.c), now.c.cross(now.a), now.a.cross(now.b);
    const double growth = now.a.dot(now.b.cross(now.c)) - e.volume;
    Eigen::Matrix<double, 9, 9> second = gradient * gradient.transpose();
    const auto couple = [&](int i, int j, const Mat3& k) {
        second.block<3, 3>(3 * i, 3 * j) += growth * k;
        second.block<3, 3>(3 * j, 3 * i) += growth * k.transpose();
    };
    couple(0, 1, -cross_matrix(now.c));
    couple(0, 2, cross_matrix(now.b));
    couple(1, 2, -cross_matrix(now.a));
    Eigen::Matrix<double, 24, 9> frame = Eigen::Matrix<double, 24, 9>::Zero();
    for (int k = 0; k < 8; ++k)
        for (int i = 0; i < 3; ++i)
            frame.block<3, 3>(3 * k, 3 * i)
                .diagonal()
                .setConstant(
                    0.25 *
                    BoxFrame::sides[static_cast<std::size_t>(k)][static_cast<std::size_t>(i)]);
    K += kappa / e.volume * congruent(frame, second);
    return K;
}

ElementTangent<4> positive_part(const ElementTangent<4>& K) { return without_negative_modes(K); }
ElementTangent<8> positive_part(const ElementTangent<8>& K) { return without_negative_modes(K); }

}  // namespace incise::physics
