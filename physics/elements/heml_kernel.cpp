// SPDX-License-Identifier: LGPL-3.0-or-later
#include "incise/physics/elements/heml_kernel.h"

#include <Eigen/LU>

#include "incise/physics/laws/stiffening.h"
#include "incise/topology/geometry.h"

namespace incise::physics {

// Needles have edges that are nearly parallel, so that V is inverted with full pivoting. An inverse
// by cofactors would have the square of this loss of accuracy.
LinkElement link_element(const std::array<Vec3, 4>& X, const Vec3& fibre) {
    const Mat3 V = edge_matrix(X);
    return {{topology::tetrahedron_volume(X[0], X[1], X[2], X[3]), squared_links(X),
             V.fullPivLu().inverse(), fibre},
            V};
}

Mat3 displacement_gradient(const LinkElement& e, const std::array<Vec3, 4>& x) {
    return (edge_matrix(x) - e.edges) * e.inverse_edges;
}

Deformation deformation(const LinkElement& e, const std::array<Vec3, 4>& x) {
    const Mat3 H = displacement_gradient(e, x);
    Deformation d;
    d.F = Mat3::Identity() + H;
    d.twice_strain = H + H.transpose() + H.transpose() * H;
    d.strain = {d.twice_strain.trace(), d.twice_strain.squaredNorm(), d.F.determinant(),
                e.fibre.dot(d.twice_strain * e.fibre)};
    return d;
}

std::array<Vec3, 4> forces_of_first_stress(const LinkElement& e, const Mat3& P) {
    const Mat3 f = -e.volume * (P * e.inverse_edges.transpose());
    return {-f.rowwise().sum(), f.col(0), f.col(1), f.col(2)};
}

Mat3 second_stress_without_volume(const LawResponse<double>& r, const Mat3& twice_strain,
                                  const Vec3& fibre) {
    Mat3 S = 4.0 * r.w_b * twice_strain;
    S.diagonal().array() += 2.0 * r.w_a;
    if (r.w_f != 0.0) S += 2.0 * r.w_f * fibre * fibre.transpose();
    return S;
}

Mat3 cofactors(const Mat3& F) {
    Mat3 result;
    result << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    return result;
}

LinkElement HemlKernel::precompute(const Corners& X, const Vec3& fibre) const {
    return link_element(X, has_fibres(law) ? fibre : Vec3::Zero());
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
    return e.volume * response(law, deformation(e, x).strain, inversion_threshold).w;
}

Mat3 HemlKernel::first_piola_kirchhoff(const Element& e, const Corners& x) const {
    const Deformation d = deformation(e, x);
    const LawResponse<double> r = response(law, d.strain, inversion_threshold);
    return d.F * second_stress_without_volume(r, d.twice_strain, e.fibre) + r.w_J * cofactors(d.F);
}

std::array<Vec3, 4> HemlKernel::forces(const Element& e, const Corners& x) const {
    return forces_of_first_stress(e, first_piola_kirchhoff(e, x));
}

double HemlKernel::stiffening(const Element& e, const Corners& x) const {
    return physics::stiffening(law, deformation(e, x).strain, inversion_threshold);
}

std::array<double, 4> HemlKernel::stiffness_bounds(const Element& e, const Corners& X) const {
    const RestFibres fibres = rest_fibres(law);
    const double kappa = fibres.dispersion;
    std::array<double, 4> inverse_altitude, fibre_part;  // 1/h_i and |H g_i|
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

}  // namespace incise::physics
