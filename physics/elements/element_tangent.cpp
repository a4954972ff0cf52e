// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/element_tangent.h"

#include "incise/physics/elements/spectrum.h"

namespace incise::physics {

namespace {

/// Returns the matrix of the map v -> u x v.
Mat3 cross_matrix(const Vec3& u) {
    Mat3 m;
    m << 0.0, -u[2], u[1], u[2], 0.0, -u[0], -u[1], u[0], 0.0;
    return m;
}

/// Returns A S A^T. It uses loops, since products of these sizes by Eigen take long to compile.
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

/// Returns the tangent of a tetrahedron from the part of its corners 1 to 3. The rest follows,
/// since a translation of all four corners changes no force.
ElementTangent<4> with_first_corner(const Eigen::Matrix<double, 9, 9>& inner) {
    ElementTangent<4> K;
    K.bottomRightCorner<9, 9>() = inner;
    for (int j = 3; j < 12; j += 3)
        K.block<3, 3>(0, j) = -(K.block<3, 3>(3, j) + K.block<3, 3>(6, j) + K.block<3, 3>(9, j));
    K.bottomLeftCorner<9, 3>() = K.topRightCorner<3, 9>().transpose();
    K.topLeftCorner<3, 3>() = -(K.block<3, 3>(0, 3) + K.block<3, 3>(0, 6) + K.block<3, 3>(0, 9));
    return K;
}

/// Adds s_ij times the identity to the blocks of corners i + 1 and j + 1.
void add_scalars(const Mat3& s, Eigen::Matrix<double, 9, 9>& inner) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) inner.block<3, 3>(3 * i, 3 * j).diagonal().array() += s(i, j);
}

/// Adds the tangent of a spring between the corners i and j. A spring of zero length has none.
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

// With the invariants p of strain, the tangent is
// Vol (sum of w_pq grad p grad q^T + sum of w_p grad grad p). It is computed from the gradients g_i
// of the shape functions, whose products do not cancel in thin elements as those of links do.
ElementTangent<4> element_tangent(const HemlKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x) {
    const Deformation d = deformation(e, x);
    const LawResponse<Dual> r =
        response(kernel.law, with_derivatives(d.strain), kernel.inversion_threshold);
    const LawResponse<double> values{r.w.value, r.w_a.value, r.w_b.value, r.w_J.value, r.w_f.value};
    const Mat3 g = e.inverse_edges.transpose(), Fg = d.F * g;  // of corner i in column i - 1

    Eigen::Matrix<double, 9, 4> gradients;  // of a, b, J and f
    const auto set_gradient = [&](int invariant, const Mat3& by_corner) {
        gradients.col(invariant) = by_corner.reshaped();
    };
    set_gradient(0, 2.0 * Fg);
    set_gradient(1, 4.0 * d.F * (d.twice_strain * g));
    set_gradient(2, cofactors(d.F) * g);
    set_gradient(3, 2.0 * (d.F * e.fibre) * (e.fibre.transpose() * g));
    Eigen::Matrix4d w;
    w.col(0) = r.w_a.gradient;
    w.col(1) = r.w_b.gradient;
    w.col(2) = r.w_J.gradient;
    w.col(3) = r.w_f.gradient;
    w = (0.5 * (w + w.transpose())).eval();

    Eigen::Matrix<double, 9, 9> inner = congruent(gradients, w);
    const Mat3 G = g.transpose() * g, B = d.F * d.F.transpose();
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            inner.block<3, 3>(3 * i, 3 * j) +=
                4.0 * values.w_b * (G(i, j) * B + Fg.col(j) * Fg.col(i).transpose());
    add_scalars(g.transpose() * second_stress_without_volume(values, d.twice_strain, e.fibre) * g,
                inner);
    const Vec3 v1 = x[1] - x[0], v2 = x[2] - x[0], v3 = x[3] - x[0];
    const auto couple = [&](int i, int j, const Mat3& K) {
        inner.block<3, 3>(3 * i, 3 * j) += K;
        inner.block<3, 3>(3 * j, 3 * i) += K.transpose();
    };
    const double p = values.w_J / (6.0 * e.volume);
    couple(0, 1, -p * cross_matrix(v3));
    couple(0, 2, p * cross_matrix(v2));
    couple(1, 2, -p * cross_matrix(v1));
    return with_first_corner(e.volume * inner);
}

ElementTangent<4> tangent_of_stress(const Mat3& S, const LinkElement& e) {
    Eigen::Matrix<double, 9, 9> inner = Eigen::Matrix<double, 9, 9>::Zero();
    add_scalars(e.volume * (e.inverse_edges * S * e.inverse_edges.transpose()), inner);
    return with_first_corner(inner);
}

ElementTangent<4> element_tangent(const ViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const ViscousKernel::EndOfStep& end) {
    const HemlKernel& elastic = kernel;
    return end.share * element_tangent(elastic, e, x) + tangent_of_stress(end.stress, e);
}

// The constant first Piola-Kirchhoff stress of the nodal rule gives forces that do not depend on
// the positions.
ElementTangent<4> element_tangent(const NodalViscousKernel& kernel, const LinkElement& e,
                                  const std::array<Vec3, 4>& x,
                                  const NodalViscousKernel::EndOfStep& end) {
    const HemlKernel& elastic = kernel;
    return end.share * element_tangent(elastic, e, x);
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

// The tangent of the volume term is kappa/V (grad V' grad V'^T + (V' - V) grad grad V').
ElementTangent<8> element_tangent(const HybmssKernel& kernel, const HybmssKernel::Element& e,
                                  const std::array<Vec3, 8>& x) {
    ElementTangent<8> K = ElementTangent<8>::Zero();
    for (std::size_t g = 0; g < HybmssKernel::springs.size(); ++g)
        for (const auto& [i, j] : HybmssKernel::springs[g])
            add_spring(i, j, e.springs.stiffnesses[g], e.springs.lengths[g], x, K);
    const double kappa = kernel.material.volume_modulus;
    if (kappa == 0.0) return K;
    // Derivatives by the mean edges a, b and c. A motion of one corner changes each of them by plus
    // or minus a quarter of the motion.
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
ElementTangent<5> positive_part(const ElementTangent<5>& K) { return without_negative_modes(K); }
ElementTangent<6> positive_part(const ElementTangent<6>& K) { return without_negative_modes(K); }
ElementTangent<8> positive_part(const ElementTangent<8>& K) { return without_negative_modes(K); }

}  // namespace incise::physics
